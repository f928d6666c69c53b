"""Output languages: a printer writes expressions, a template arranges text, and neither computes."""
