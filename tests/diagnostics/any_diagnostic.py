"""Any diagnostic that the types allow, with the sources that it may or may not point into."""

from __future__ import annotations

from hypothesis import strategies as st

from xei_lang.diagnostics import CATALOGUE, Diagnostic, Edit, Fix, Label, Source, Span

NASTY = "\x00\x07\x1b[31m\x7f\x9b\r\n\t\u2028\u202e\ufffe\ud800\udcff%:,;|\"'<>&]]>`\\ \U0001f9ea\u00b5"

texts = st.text(st.one_of(st.sampled_from(NASTY), st.characters()), max_size=25)
files = st.one_of(st.sampled_from(["p.xei", "/abs/p.xei", "a b:c.yaml", "-p\x1b.xei"]), texts)
spans = st.builds(
    lambda file, start, length: Span(file, start, start + length),
    files,
    st.integers(0, 60),
    st.integers(0, 30),
)
fixes = st.builds(
    Fix,
    st.sampled_from(["safe", "unsafe", "display"]),
    st.lists(st.builds(Edit, spans, texts), min_size=1, max_size=3).map(tuple),
)
diagnostics = st.builds(
    Diagnostic,
    st.sampled_from(sorted(CATALOGUE)),
    texts.map(lambda text: text or "?"),
    st.none() | spans,
    texts,
    st.lists(st.builds(Label, spans, texts), max_size=3).map(tuple),
    st.lists(texts, max_size=2).map(tuple),
    st.lists(texts, max_size=2).map(tuple),
    st.none() | fixes,
)
some = st.lists(diagnostics, max_size=4).map(tuple)
sources = st.dictionaries(files, texts, max_size=4).map(
    lambda found: {file: Source(file, text) for file, text in found.items()}
)
