"""Closed forms, the judge, tables, figures and the command line."""
