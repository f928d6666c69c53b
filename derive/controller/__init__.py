"""Axis values of a controller, live and read only, for the page that draws the machine.

It may import the folders from `ir` to `view`. A source is named by the settings, and writes its values to the feed; the
stream makes messages of the feed, and the server sends them. What the extra `live` brings is imported when it is used.

addresses: where values come from, and what kind of source that is
admission: who may connect to the server
channels: which node of the controller is which axis, and its scale
connection: a source that is asked again after a loss
credentials: user name and password, from the environment or from a terminal
feed: the newest reading of each axis, and how the connection is
machine: the machine that is shown: its axes and its parameters
messages: the messages that the page gets
reading: what a source says about one axis
refusal: what ends a connection, for good or until it is tried again
run: a live connection put together from its settings
server: the server of the page and of its WebSocket
settings: all that a live connection is told, from JSON and from the command line
sources/: the sources
stream: one message for all pages, at most so many times a second
"""
