"""Turns photographs into vector stroke art, by the ``drypoint`` command that this package carries.

>>> import drypoint
>>> drawing = drypoint.draw("portrait.jpg", style="hedcut", size="38x50mm", pitch=0.4)
>>> drawing.layers[0].dots          # x, y and radius in millimetres
>>> drawing.save("portrait.pdf")

All lengths are millimetres; x points right and y down, from the sheet's upper left corner.
"""

from ._command import command, version
from ._drawing import Drawing, Layer, Stroke
from ._errors import DrypointError, DrypointWarning
from ._photograph import Picture
from ._request import draw

__all__ = ["Drawing", "DrypointError", "DrypointWarning", "Layer", "Picture", "Stroke", "command", "draw", "version"]
