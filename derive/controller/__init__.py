"""Axis values of a controller, live and read only, for the page that draws the machine.

It may import the folders from `ir` to `view`. The settings name a source, which writes its values to the feed; the
stream makes messages of the feed, and the server sends them. Packages of the extra `live` are imported when they are
used.

addresses: the address of a source, and its kind
admission: who may connect to the server
channels: the node of the controller for each axis, and its scale
credentials: user name and password, from the environment or from a terminal
feed: the newest reading of each axis, and the state of the connection
machine: the machine that is shown: its axes and its parameters
messages: the messages that the page gets
reading: the answer of a source about one axis
refusal: the errors that end a connection, for good or until it is tried again
run: a live connection put together from its settings, and tried again when it is lost
server: the server of the page and of its WebSocket
settings: the settings of a live connection, from JSON and from the command line
sources/: the sources
stream: one message for all pages, at a limited rate
"""
