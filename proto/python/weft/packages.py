"""The packages that are used where they are installed."""

try:
    import numpy
except ImportError:  # optional; everything works without it
    numpy = None

try:
    import websockets
except ImportError:  # only the decoders work without it
    websockets = None


