"""A drawing as a picture: projected, arranged on a page, and written as PNG and SVG."""
