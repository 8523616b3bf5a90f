"""The tables of a scene file that say how the ribbon grows, and what all tables have in common.

pydantic checks which keys there are, here as in `ribbonrs.scenefile`.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, Discriminator, Tag, model_validator
from pydantic_core import PydanticCustomError

from . import growth as growths
from .errors import InputError
from .growth import Growth

__all__ = ["TABLE", "VALUE", "Along", "GrowthTable", "Table", "as_list", "table_or_value"]


class Table(BaseModel):
    """A table of known keys. A value of type Any is checked by the class it is for."""

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, data: object) -> object:
        for key in data if isinstance(data, dict) else ():
            if key not in cls.model_fields:
                context = {"key": key, "known": list(cls.model_fields)}
                raise PydanticCustomError("unknown_key", "unknown key", context)
        return data

    def given(self) -> dict[str, Any]:
        """The keys in the file, apart from `kind`, and their values."""
        given = self.model_fields_set - {"kind"}
        values = {key: getattr(self, key) for key in type(self).model_fields if key in given}
        return {key: v.pair() if isinstance(v, _Samples) else v for key, v in values.items()}


def as_list(value: object) -> object:
    """Let a single entry stand for a list of one."""
    return value if isinstance(value, list) else [value]


class _Samples(Table):
    """Samples: TOML has no tuples."""

    def pair(self) -> tuple[Any, ...]:
        """Places and values as Python takes them: sequences, for two numbers would be a polynomial."""
        return tuple(as_list(getattr(self, key)) for key in type(self).model_fields)


class _AcrossSamples(_Samples):
    x: Any
    values: Any


class _AlongSamples(_Samples):
    S: Any
    values: Any


TABLE, VALUE = "<table>", "<value>"
"""What pydantic adds to the path of a key that may be a table or a value."""


def table_or_value(value: object) -> str:
    """Tell which of the two it is."""
    return TABLE if isinstance(value, dict) else VALUE


_Value = Annotated[Any, Tag(VALUE)]
Across = Annotated[Annotated[_AcrossSamples, Tag(TABLE)] | _Value, Discriminator(table_or_value)]
Along = Annotated[Annotated[_AlongSamples, Tag(TABLE)] | _Value, Discriminator(table_or_value)]


class _ThicknessTable(Table):
    xi: Along
    transverse: Along = None


class _ProfileTable(Table):
    name: Any = None
    amplitude: Along = None
    breaks: Any = None
    spline: Any = None
    gamma33: Across = None
    d33: Across = None
    d22: Across = None
    d23: Across = None
    g21: Across = None
    g31: Across = None
    gamma22: Across = None
    gamma23: Across = None


class _CsvTable(Table):
    path: Any
    name: Any = None
    width: Any = None
    breaks: Any = None
    spline: Any = None

    def make(self, directory: Path) -> Growth:
        given = self.given()
        if isinstance(self.path, str):
            given["path"] = directory / self.path
        return growths.from_csv(**given)


def _as_thickness(value: object) -> object:
    keys = value.keys() if isinstance(value, dict) else {"S"}
    return {"xi": value} if {"S", "values"} & keys and not {"xi", "transverse"} & keys else value


def _as_csv(value: object) -> object:
    return value if isinstance(value, dict) else {"path": value}


class GrowthTable(Table):
    """The table [growth]."""

    edge: Along = None
    thickness: Annotated[_ThicknessTable, BeforeValidator(_as_thickness)] | None = None
    chiral: Along = None
    profile: Annotated[list[_ProfileTable], BeforeValidator(as_list)] = []
    csv: Annotated[_CsvTable, BeforeValidator(_as_csv)] | None = None

    def make(self, directory: Path) -> Growth:
        """Return the sum of all that is in the table; files are relative to `directory`."""
        given = self.given()
        terms = []
        if self.edge is not None:
            terms.append(growths.edge(given["edge"]))
        if self.thickness is not None:
            terms.append(growths.thickness(**self.thickness.given()))
        if self.chiral is not None:
            terms.append(growths.chiral(given["chiral"]))
        terms.extend(self._profiles())
        if self.csv is not None:
            terms.append(self.csv.make(directory))
        if not terms:
            raise InputError("growth", {}, f"at least one of {', '.join(type(self).model_fields)}")
        return sum(terms[1:], start=terms[0])

    def _profiles(self) -> Iterator[Growth]:
        for i, profile in enumerate(self.profile):
            try:
                yield growths.Profile(**profile.given())
            except InputError as error:
                # Of several it is told which.
                several = "growth.profile" if len(self.profile) == 1 else f"growth.profile[{i}]"
                field = error.field.replace("growth.profile", several, 1)
                raise InputError(field, error.value, error.expected) from None

    def reads(self, directory: Path) -> tuple[Path, ...]:
        """Return the files that are read."""
        return () if self.csv is None else (directory / self.csv.path,)
