"""softland: simulation of MEMS and NEMS switches, and search for waveforms that close them without bounce.

>>> import softland
>>> scene = softland.load("scenes/mem-gold.toml")
>>> closing = scene.simulate()
>>> closing.impact_velocity
0.08558113969278344 ± 1.6e-08 m/s

All numbers are in SI units; text with a unit is read as in a scene file. docs/python.md is the introduction.
"""

from . import _softland
from ._arguments import check_arguments
from ._closing import Closing
from ._errors import InvalidInput
from ._evaluator import Evaluator
from ._outcome import Outcome
from ._recording import Recording, contact_edges, read
from ._records import Quantity, Record
from ._results import Result, Store, open
from ._scene import Modes, Scene, load, shipped
from ._tuning import PracticeDevice, Shot, Tuning
from ._units import units
from ._waveform import OwnWaveform, Waveform

__version__: str = _softland.version

__all__ = [
    "Closing", "Evaluator", "InvalidInput", "Modes", "Outcome", "OwnWaveform", "PracticeDevice", "Quantity", "Record", "Recording", "Result", "Scene", "Shot", "Store", "Tuning", "Waveform",
    "contact_edges", "load", "open", "read", "shipped", "units",
]  # fmt: skip

check_arguments(globals(), __all__)
