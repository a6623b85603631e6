"""What a scene file may contain, read off the JSON Schema of its model.

Messages, documentation and completion all ask here, so that they never disagree with what is checked.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .located_json import Loc

Schema = dict[str, Any]


def resolve(root: Schema, node: Schema) -> Schema:
    """`node` itself, or what its `$ref` names; for "X or null" the X."""
    if "$ref" in node:
        return resolve(root, root["$defs"][node["$ref"].rsplit("/", 1)[1]])
    others = [other for other in node.get("anyOf", ()) if other.get("type") != "null"]
    return resolve(root, others[0]) if len(others) == 1 else node


def nullable(node: Schema) -> bool:
    """Whether null may stand there."""
    return any(choice.get("type") == "null" for choice in node.get("anyOf", ()))


def node_at(root: Schema, loc: Loc) -> Schema | None:
    """The schema of the value at `loc`, before references are followed; None where no such key is known."""
    node = root
    for step in loc:
        inner = resolve(root, node)
        following: Any
        if isinstance(step, str):
            following = inner.get("properties", {}).get(step)
        else:
            prefix = inner.get("prefixItems", [])
            following = prefix[step] if step < len(prefix) else inner.get("items")
        if not isinstance(following, dict):
            return None
        node = following
    return node


def keys_at(root: Schema, loc: Loc) -> list[str]:
    """The known keys of the object at `loc`."""
    node = node_at(root, loc)
    return list(resolve(root, node).get("properties", {})) if node is not None else []


def all_keys(root: Schema, node: Schema | None = None, prefix: str = "") -> Iterator[tuple[str, Schema]]:
    """Every key of the scene file with its schema, as ("framebuffer.res_w", {...}), sections included."""
    for name, child in resolve(root, node or root).get("properties", {}).items():
        path = f"{prefix}{name}"
        yield path, child
        inner = resolve(root, child)
        if inner.get("type") == "array" and "items" in inner:
            yield from all_keys(root, inner["items"], f"{path}[].")
        elif "properties" in inner:
            yield from all_keys(root, inner, f"{path}.")


def describe(root: Schema, node: Schema) -> str:
    """What may stand there, in words: `a number from 0 to 1`, `power, balance, none`, `true or false`."""
    inner = resolve(root, node)
    return _describe_value(root, inner) + (" or null" if nullable(node) else "")


def choices(root: Schema, node: Schema) -> list[Any]:
    """The values that a choice accepts; empty for anything else."""
    inner = resolve(root, node)
    return list(inner.get("enum", [inner["const"]] if "const" in inner else []))


def _describe_value(root: Schema, node: Schema) -> str:
    if names := choices(root, node):
        return ", ".join(str(choice) for choice in names)
    kind = node.get("type")
    if kind == "number":
        return "a number" + _range(node)
    if kind == "integer":
        return "a whole number" + _range(node)
    if kind == "boolean":
        return "true or false"
    if kind == "string":
        return "a text that is not empty" if node.get("minLength") else "a text"
    if kind == "array" and "prefixItems" in node:
        return "three numbers" + _range(resolve(root, node["prefixItems"][0]))
    if kind == "array":
        item = resolve(root, node.get("items", {}))
        return "a list of texts" if item.get("type") == "string" else "a list of objects"
    keys = ", ".join(node.get("properties", {}))
    return f"an object with the keys {keys}" if keys else "an object"


def _range(node: Schema) -> str:
    low, high = node.get("minimum"), node.get("maximum")
    above, below = node.get("exclusiveMinimum"), node.get("exclusiveMaximum")
    if low is not None and high is not None:
        return f" from {low:.15g} to {high:.15g}"
    if above is not None and below is not None:
        return f" above {above:.15g} and below {below:.15g}"
    parts = [
        f"{word} {bound:.15g}"
        for word, bound in (("of at least", low), ("above", above), ("of at most", high), ("below", below))
        if bound is not None
    ]
    return f" {' and '.join(parts)}" if parts else ""
