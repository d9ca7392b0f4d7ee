"""Diagnostics as text: one file for each form. Nothing here prints; the caller does."""
