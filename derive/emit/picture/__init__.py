"""A drawing as a picture: projected, arranged on a page, and written as PNG and SVG.

It may import no other folder of `emit`.

canvas: marks as PNG and as SVG
ink: the marks: lines, areas, texts
machine: the machine on its part of the page
naming: the names of joints, frames and points, labels as text, and dimensions with their lines
page: the whole pictures
panel: the choices of the configuration, as small pictures
placing: the places of labels, of several possible ones those that cover least
series: names that are told once for all legs
style: colours and sizes
symbols: the shapes of links, joints, rails and frames
view: the projection of the machine to the page
words: the sentences
"""
