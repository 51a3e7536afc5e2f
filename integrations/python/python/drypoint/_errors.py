"""What goes wrong while drawing."""


class DrypointError(RuntimeError):
    """The command could not do its work; the message is its own."""


class DrypointWarning(UserWarning):
    """The command warns of something in the drawing, such as marks that a press cannot print."""
