"""A drawing as a picture: projected, arranged on a page, and written as PNG and SVG.

It may import no other folder of `emit`.

canvas: marks as PNG and as SVG
ink: the marks: lines, areas, texts
machine: the machine on its part of the page
naming: the names of joints, frames and points, and dimensions with their lines
page: the whole picture
panel: the choices of the configuration, as small pictures
placing: the places of labels, of several possible ones those that cover least
rails: the rails of linear motions, and their arrows
spelling: labels as text
style: colours and sizes
symbols: the shapes of links, joints, rails and frames
vector: marks as elements of SVG
view: the projection of the machine to the page
"""
