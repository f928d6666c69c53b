"""How fast, how exact and how complete: the generated Python against peers, on the same poses in one run; and what a
block costs beside one that is written by hand."""
