"""The page of a service: each method is a form that a person can send.

Rules: plain HTML without a script; a form sends what a person would type (`set_speed 1.5`), and the
port's own page shows the answer. A struct has an input for each of its values, a list takes its
elements as YARP writes them: `1 2 3`, `(1 2) (3 4)`. Names and documentation are escaped.
"""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING, Any, Final

from yarpy.kits.thrift.kind import (
    BOOL,
    TEXT,
    Kind,
    ListOf,
    MapOf,
    Scalar,
    SetOf,
    flat,
    is_enum,
    is_struct,
    name_of,
)

if TYPE_CHECKING:
    from yarpy.kits.thrift.method import Method

#: inputs of a form; a struct of more values is one input
_INPUTS: Final = 40
_CHOSEN: Final = ("", " selected")


def page(service: Any) -> str:
    """The whole page."""
    name = type(service).__name__
    forms = "\n".join(_form(method) for method in service._methods.values())
    doc = f"<p>{escape(type(service).__doc__ or '')}</p>" if type(service).__doc__ else ""
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{escape(name)}</title>"
        '<link rel="stylesheet" href="/*/style.css"><link rel="stylesheet" href="/*/port.css">'
        f"</head>\n<body><header><h1>{escape(name)}</h1>"
        '<nav><a href="/*">port</a><a href="/data=help">help</a></nav></header>\n'
        f'<main id="port">{doc}\n{forms}\n</main></body></html>\n'
    )


def _form(method: Method) -> str:
    words: list[str] = [method.name]
    inputs: list[str] = []
    first = len(method.parts) - len(method.defaults)
    for at, part in enumerate(method.parts):
        default = method.defaults[at - first]() if at >= first else None
        whole = len(inputs) + flat(part.kind) > _INPUTS
        fields = _Fields(inputs, whole)
        words.append(fields.text(part.kind, part.name, default, part.nested))
    doc = f"<small>{escape(method.doc)}</small>" if method.doc else ""
    return (
        f'<form method="post" action="/form" id="{escape(method.name)}">'
        f'<input type="hidden" name="data" value="{escape(" ".join(words))}">'
        f"<code>{escape(method.prototype)}</code>"
        f'{"".join(inputs)}<input type="submit" value="call">{doc}</form>'
    )


class _Fields:
    """Adds the inputs of values to `inputs`; `text` is what stands for a value in the message."""

    def __init__(self, inputs: list[str], whole: bool) -> None:
        self.inputs = inputs
        self.whole = whole

    def text(self, kind: Kind, name: str, value: Any, nested: bool = False) -> str:
        if is_struct(kind) and not self.whole:
            specs: Any = kind._specs()  # type: ignore[union-attr]
            made = kind() if value is None else value  # type: ignore[operator]
            inner = " ".join(
                self.text(
                    each.kind, f"{name}.{each.name}", getattr(made, each.attribute), each.nested
                )
                for each in specs
            )
            return f"({inner})" if nested else inner
        if kind is BOOL:
            return self.choice(name, [("1", "true"), ("0", "false")], "1" if value else "0")
        if is_enum(kind):
            members: Any = kind
            options = [(str(int(each)), each.name) for each in members]
            return self.choice(name, options, "" if value is None else str(int(value)))
        if kind is TEXT:
            return f'"{self.input(name, kind, value or "")}"'
        if isinstance(kind, (ListOf, SetOf, MapOf)) or nested:
            hint = "(key value) (key value)" if isinstance(kind, MapOf) else ""
            return f"({self.input(name, kind, _listed(value), hint)})"
        return self.input(name, kind, "" if value is None else _shown(value))

    def field(self, spec: Any, name: str, struct: Any) -> str:
        value = getattr(struct, spec.attribute)
        return self.text(spec.kind, f"{name}.{spec.name}", value, spec.nested)

    def input(self, name: str, kind: Kind, value: str, hint: str = "") -> str:
        label = escape(name)
        what = hint or name_of(kind)
        needed = " required" if isinstance(kind, Scalar) and kind is not TEXT else ""
        self.inputs.append(
            f'<label>{label} <input name="a{len(self.inputs)}" placeholder="{escape(what)}" '
            f'aria-label="{label}" size="12" value="{escape(value)}"{needed}></label>'
        )
        return f"$a{len(self.inputs) - 1}"

    def choice(self, name: str, options: list[tuple[str, str]], chosen: str) -> str:
        label = escape(name)
        shown = "".join(
            f'<option value="{value}"{_CHOSEN[value == chosen]}>{escape(text)}</option>'
            for value, text in options
        )
        self.inputs.append(
            f'<label>{label} <select name="a{len(self.inputs)}" aria-label="{label}">'
            f"{shown}</select></label>"
        )
        return f"$a{len(self.inputs) - 1}"


def _shown(value: Any) -> str:
    return repr(value) if isinstance(value, float) else str(value)


def _listed(value: Any) -> str:
    """Elements as YARP writes them."""
    return " ".join(_each(value)) if value is not None and not hasattr(value, "_specs") else ""


def _each(value: Any) -> Iterator[str]:
    from yarpy.data.bottle import Bottle

    items = value.items() if isinstance(value, dict) else value
    for item in items:
        if isinstance(item, (str, int, float, bool)):
            yield Bottle([item]).to_text()
