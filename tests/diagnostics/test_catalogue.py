"""The files of the catalogue make one: each code is of a range, and each range stands in one file."""

from __future__ import annotations

from xei_lang.diagnostics.catalogue import CATALOGUE, RANGES, motion, profiles, protocols, runs


def test_every_code_is_of_a_range():
    assert {code[:5] for code in CATALOGUE} <= RANGES.keys()


def test_no_range_stands_in_two_files():
    files = (protocols.ENTRIES, profiles.ENTRIES, motion.ENTRIES, runs.ENTRIES)
    ranges = [{code[:5] for code in entries} for entries in files]
    assert sum(map(len, ranges)) == len(set().union(*ranges))
