"""Writes the blocking form of the Python client from the asynchronous one, so that neither has what the other lacks."""

import ast
import textwrap

from generate_python import head_of, wrapped

HEAD = '"""The calls of `Client`, blocking. Written by proto/generate.py from the asynchronous ones."""'
OTHERWISE = {"close"}  # ends the loop too


def is_generator(method):
    return any(isinstance(node, (ast.Yield, ast.YieldFrom)) for node in ast.walk(method))


def methods_of(tree):
    """The public coroutines of a module's classes, in their order."""
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            for method in node.body:
                public = isinstance(method, ast.AsyncFunctionDef) and method.name[0] != "_"
                if public and method.name not in OTHERWISE and not is_generator(method):
                    yield method


def arguments_of(method):
    """The arguments as they are declared, and as they are passed on."""
    given, passed = method.args, []
    declared, usual = [], [None] * (len(given.args) - len(given.defaults)) + given.defaults

    def declare(argument, default, mark=""):
        kind = f": {ast.unparse(argument.annotation)}" if argument.annotation else ""
        value = f" = {ast.unparse(default)}" if default is not None else ""
        return mark + argument.arg + kind + value

    for argument, default in zip(given.args, usual):
        declared.append(declare(argument, default))
        passed.append(argument.arg)
    if given.kwonlyargs:
        declared.append("*")
    for argument, default in zip(given.kwonlyargs, given.kw_defaults):
        declared.append(declare(argument, default))
        passed.append(f"{argument.arg}={argument.arg}")
    if given.kwarg:
        declared.append(declare(given.kwarg, None, "**"))
        passed.append(f"**{given.kwarg.arg}")
    return declared, passed[1:]


def quoted(text):
    """Strings in double quotes, as the other sources have them."""
    return text.replace("'", '"')


def blocking_method(method, overloads):
    """One of them; `overloads` are the names of those that have several forms, which a checker cannot pass on."""
    declared, passed = arguments_of(method)
    overloaded = bool(method.decorator_list)
    if overloaded:
        yield "    @overload"
    end = f" -> {ast.unparse(method.returns)}:" + (" ..." if overloaded else "")
    yield from map(quoted, head_of(f"def {method.name}", declared, end))
    if overloaded:
        return
    doc = ast.get_docstring(method)
    if doc:
        yield from textwrap.indent(f'"""{doc}' + ('\n"""' if "\n" in doc else '"""'), " " * 8).split("\n")
    target = f"self._client.{method.name}"
    if method.name in overloads:
        yield f"        wanted: Any = {target}"
        target = "wanted"
    call = f"        return self._run({target}({', '.join(passed)}))"
    if len(call) <= 118:
        yield call
    else:
        yield from (f"        call = {target}(", *wrapped(passed, " " * 12), "        )  # fmt: skip")
        yield "        return self._run(call)"


def origins(trees):
    """Module of each name that is imported or defined there."""
    found = {}
    for module, tree in trees.items():
        for node in tree.body:
            if isinstance(node, ast.ImportFrom) and node.module != "__future__":
                found |= {name.name: "." * node.level + (node.module or "") for name in node.names}
            elif isinstance(node, ast.ClassDef):
                found[node.name] = "." + module
            elif isinstance(node, ast.Assign):
                found |= {target.id: "." + module for target in node.targets}
    return found


def names_in(method):
    """Those that its head uses."""
    heads = [*method.args.args, *method.args.kwonlyargs, *([method.args.kwarg] if method.args.kwarg else [])]
    parts = [a.annotation for a in heads if a.annotation] + [method.returns]
    parts += method.args.defaults + [d for d in method.args.kw_defaults if d is not None] + method.decorator_list
    return {node.id for part in parts for node in ast.walk(part) if isinstance(node, ast.Name)}


def blocking_commands(sources):
    """The blocking form of the public coroutines in some sources, by the names of their modules."""
    trees = {module: ast.parse(source) for module, source in sources.items()}
    methods = [method for tree in trees.values() for method in methods_of(tree)]
    known, modules = origins(trees), {}
    for name in set().union(*map(names_in, methods)) & set(known):
        modules.setdefault(known[name], []).append(name)
    yield from (HEAD, "", "from __future__ import annotations", "")
    outer = sorted(module for module in modules if module[0] != ".")
    inner = sorted([*(module for module in modules if module[0] == "."), ".runner"])
    modules[".runner"] = ["Runner"]
    for module in [*outer, "", *inner]:
        names = sorted(modules[module]) if module else []
        line = f"from {module} import {', '.join(names)}" if module else ""
        if len(line) <= 118:
            yield line
        else:
            yield from (f"from {module} import (", *wrapped(names, " " * 4), ")  # fmt: skip")
    yield from ("", "", "class BlockingCommands(Runner):", '    """What `Client` does, without waiting in the caller."""')
    overloads = {method.name for method in methods if method.decorator_list}
    for method in methods:
        yield from ("", *blocking_method(method, overloads))
