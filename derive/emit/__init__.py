"""Languages: a printer spells expressions, a template arranges text, neither computes."""
