"""Checks arguments of the public functions against their annotations: a message names the argument, the expected type and the value."""

from __future__ import annotations

import collections.abc
import functools
import inspect
import os
import sys
import types
import typing
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import WrongType

_MOST_ELEMENTS = 1000  # largest number of elements of a sequence that are checked
_SPECIAL = ("__init__", "__call__", "__getitem__", "__setitem__", "__delitem__")
_OF_PYBIND = ("incompatible function arguments", "incompatible constructor arguments", "Unable to cast")


def _is_number(value: Any) -> bool:
    if isinstance(value, (bool, np.bool_, str, bytes, complex)):
        return False
    try:
        float(value)
    except (TypeError, ValueError):
        return False
    return True


def _is_array(value: Any) -> bool:
    if isinstance(value, (str, bytes)):
        return False
    try:
        np.asarray(value, float)
    except (TypeError, ValueError):
        return False
    return value is not None


def _fits(value: Any, hint: Any) -> bool:
    """Returns True if a value fits an annotation; every value fits an annotation of an unknown kind."""
    if hint is Any:
        return True
    if hint is None or hint is type(None):
        return value is None
    if hint is npt.ArrayLike or hint == npt.ArrayLike:
        return _is_array(value)
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if origin is typing.Union or isinstance(hint, types.UnionType):
        return any(_fits(value, one) for one in inner)
    if origin is typing.Literal:  # the called function checks the value itself
        return any(type(value) is type(one) for one in inner)
    if origin is np.ndarray or hint is np.ndarray:
        return _is_array(value)
    if origin is collections.abc.Callable or hint is collections.abc.Callable:
        return callable(value)
    if hint is bool:
        return isinstance(value, (bool, np.bool_))
    if hint is int:
        return isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if hint is float:
        return _is_number(value)
    kind = origin if origin is not None else hint
    if not isinstance(kind, type):
        return True
    if issubclass(kind, collections.abc.Mapping):
        if not isinstance(value, collections.abc.Mapping):
            return False
        if len(inner) != 2:
            return True
        return all(_fits(key, inner[0]) and _fits(one, inner[1]) for key, one in value.items())
    if issubclass(kind, tuple) and inner:
        if isinstance(value, (str, bytes)) or not isinstance(value, collections.abc.Sequence):
            return False
        if inner[-1] is Ellipsis:
            return all(_fits(one, inner[0]) for one in value)
        return len(value) == len(inner) and all(map(_fits, value, inner))
    if kind in (collections.abc.Sequence, collections.abc.Iterable, list):
        if isinstance(value, (str, bytes, collections.abc.Mapping)) or not isinstance(value, collections.abc.Iterable):
            return False
        if not inner or not isinstance(value, collections.abc.Sized):
            return True
        return all(_fits(one, inner[0]) for one, _ in zip(value, range(_MOST_ELEMENTS)))
    return isinstance(value, kind)


def _words(hint: Any) -> str:
    """Returns the expected type in words."""
    if hint is None or hint is type(None):
        return "None"
    if hint is npt.ArrayLike or hint == npt.ArrayLike:
        return "numbers as an array"
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if origin is typing.Union or isinstance(hint, types.UnionType):
        return " or ".join(dict.fromkeys(_words(one) for one in inner))
    if origin is typing.Literal:
        return " or ".join(dict.fromkeys(repr(one) for one in inner))
    if origin is np.ndarray or hint is np.ndarray:
        return "an array"
    if origin is collections.abc.Callable or hint is collections.abc.Callable:
        return "a function"
    named = {bool: "True or False", int: "a whole number", float: "a number", str: "text"}
    if hint in named:
        return named[hint]
    kind = origin if origin is not None else hint
    if isinstance(kind, type):
        if issubclass(kind, collections.abc.Mapping) and origin is not None and len(inner) == 2 and inner[1] is not Any:
            return f"a mapping of {_words(inner[0])} to {_words(inner[1])}"
        if issubclass(kind, collections.abc.Mapping):
            return "a mapping"
        if issubclass(kind, tuple) and inner and inner[-1] is not Ellipsis:
            return "(" + ", ".join(_words(one) for one in inner) + ")"
        if kind in (collections.abc.Sequence, collections.abc.Iterable, list, tuple):
            return "a list" + (f" of {_words(inner[0])}" if inner and inner[0] is not Any else "")
        if issubclass(kind, os.PathLike):
            return "a path"
        return f"a {kind.__name__}"
    return str(hint)


def _shown(value: Any) -> str:
    text = repr(value)
    return f"{text if len(text) <= 80 else text[:77] + '...'} ({type(value).__name__})"


@functools.lru_cache(maxsize=None)
def _hints(function: Callable[..., Any]) -> dict[str, Any]:
    """Returns the annotations that can be evaluated at run time, by parameter."""
    names = {**vars(sys.modules["softland"]), **vars(sys.modules[function.__module__])}
    found: dict[str, Any] = {}
    for name, text in getattr(function, "__annotations__", {}).items():
        if name == "return":
            continue
        try:
            found[name] = eval(text, names) if isinstance(text, str) else text  # noqa: S307: our own annotations
        except (NameError, AttributeError, TypeError):
            continue
    return found


def _check(function: Callable[..., Any], name: str, arguments: tuple[Any, ...], named: Mapping[str, Any]) -> None:
    signature = inspect.signature(function)
    try:
        bound = signature.bind(*arguments, **named)
    except TypeError:  # too many, too few or unknown arguments: the message of Python names them
        return
    for parameter, hint in _hints(function).items():
        if parameter not in bound.arguments:
            continue
        value = bound.arguments[parameter]
        kind = signature.parameters[parameter].kind
        if kind is inspect.Parameter.VAR_KEYWORD:
            rows = [(key, one) for key, one in value.items()]
        elif kind is inspect.Parameter.VAR_POSITIONAL:
            rows = [(parameter, one) for one in value]
        else:
            rows = [(parameter, value)]
        for key, one in rows:
            if not _fits(one, hint):
                raise WrongType(f"{name}: {key} must be {_words(hint)}, not {_shown(one)}", key=key)


def _checked(function: Callable[..., Any], name: str) -> Callable[..., Any]:
    @functools.wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        _check(function, name, arguments, named)
        try:
            return function(*arguments, **named)
        except (TypeError, RuntimeError) as error:
            if not any(words in str(error) for words in _OF_PYBIND):
                raise
            given = ", ".join([*map(_shown, arguments), *(f"{key}={_shown(one)}" for key, one in named.items())])
            raise WrongType(f"{name}: an argument has the wrong type: {given}") from None

    return call


def check_arguments(namespace: Mapping[str, Any], names: list[str]) -> None:
    """Adds the check of arguments to the named functions, and to the public methods of the named classes."""
    for name in names:
        one = namespace[name]
        if inspect.isclass(one) and not issubclass(one, Exception):
            package = one.__module__.partition(".")[0]
            own = [base for base in reversed(one.__mro__) if base is one or (base.__module__.startswith(package) and base.__name__ not in names)]
            for key, function in [row for base in own for row in vars(base).items()]:
                if key.startswith("_") and key not in _SPECIAL:
                    continue
                called = name if key == "__init__" else f"{name}.{key}"
                if inspect.isfunction(function):
                    setattr(one, key, _checked(function, called))
                elif isinstance(function, (classmethod, staticmethod)):
                    setattr(one, key, type(function)(_checked(function.__func__, called)))
        elif inspect.isfunction(one):
            typing.cast("dict[str, Any]", namespace)[name] = _checked(one, name)
