"""The viewer: one HTML page with machines in it, made of the modules in JavaScript and of `runtime/view`.

It may import the folders from `ir` to `emit`. Each module in `runtime/view` says what it holds; start reading at
`main.js`.

node: Node.js with npm, and the packages that npm installs once for the viewer
page: the page: modules, the viewer's own source, style and licences in one file
"""
