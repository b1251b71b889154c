"""The scene file: models, JSON Schema and validation. Nothing numeric, nothing of the renderer."""

from .base import Model
from .document import json_schema
from .errors import Problem, pointer
from .lights import ConstantLight, DirectionalLight, EnvmapLight, Light, PointLight
from .materials import Material
from .overhang import internal, overhangs
from .paths import CirclePath, Path, PolylinePath, SpiralPath, SvgPath
from .patterns import MAX_PLACED, Groove, Pattern
from .profiles import (
    PolylineProfile,
    Profile,
    RoundProfile,
    ScratchProfile,
    TrapezoidProfile,
    VProfile,
)
from .repeats import ConcentricRepeat, GridRepeat, LinearRepeat, Repeat, ScatterRepeat
from .scales import ConstantScale, LinearScale, Scale, SineScale, TableScale
from .scene import Camera, Mapping, Object, Render, Scene, files
from .shapes import Cylinder, Mesh, Rectangle, Shape, Sphere
from .text import MAX_BYTES
from .validate import Report, check, check_text

__all__ = [
    "MAX_BYTES",
    "MAX_PLACED",
    "Camera",
    "CirclePath",
    "ConcentricRepeat",
    "ConstantLight",
    "ConstantScale",
    "Cylinder",
    "DirectionalLight",
    "EnvmapLight",
    "GridRepeat",
    "Groove",
    "Light",
    "LinearRepeat",
    "LinearScale",
    "Mapping",
    "Material",
    "Mesh",
    "Model",
    "Object",
    "Path",
    "Pattern",
    "PointLight",
    "PolylinePath",
    "PolylineProfile",
    "Problem",
    "Profile",
    "Rectangle",
    "Render",
    "Repeat",
    "Report",
    "RoundProfile",
    "Scale",
    "ScatterRepeat",
    "Scene",
    "ScratchProfile",
    "Shape",
    "SineScale",
    "Sphere",
    "SpiralPath",
    "SvgPath",
    "TableScale",
    "TrapezoidProfile",
    "VProfile",
    "check",
    "check_text",
    "files",
    "internal",
    "json_schema",
    "overhangs",
    "pointer",
]
