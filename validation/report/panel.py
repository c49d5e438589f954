"""The place of `validation.pictures.panel` until all studies import from there."""

from validation.pictures.panel import Curve as Curve
from validation.pictures.panel import Map as Map
from validation.pictures.panel import Panel as Panel
