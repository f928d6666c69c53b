"""Instructions of a call in C on processors of controllers: `make costs`."""
