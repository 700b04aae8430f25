"""Makes a failing script of weft_fuzz as small as it stays failing.

    build/weft_fuzz --seed 1 --scene 2 --print | head -1 > case.json
    /usr/bin/python3 tests/fuzz/reduce.py build/weft_fuzz case.json "guarantee is held"

Leaves out steps, elements of lists and keys of objects, and rounds numbers, as long as the output of
`weft_fuzz --script` still has the given text. Prints the script; a line of found.txt is one like it.
"""

import json
import subprocess
import sys
import tempfile


class Reducer:
    def __init__(self, program, text):
        self.program, self.text, self.tries = program, text, 0

    def fails(self, script):
        self.tries += 1
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(script, file)
            file.flush()
            result = subprocess.run([self.program, "--script", file.name], capture_output=True, text=True,
                                    check=False)
        return self.text in result.stdout + result.stderr

    def reduced(self, script):
        while True:
            before = json.dumps(script)
            script = self.shortened(script)
            for path in sorted(places(script), key=lambda path: (len(path), path_key(path))):
                script = self.without(script, path)
            for path in numbers(script):
                script = self.rounded(script, path)
            if json.dumps(script) == before:
                return script

    def shortened(self, script):
        """Without runs of steps, long ones first."""
        size = len(script) // 2
        while size >= 1:
            start = 1
            while start < len(script):
                shorter = script[:start] + script[start + size:]
                if self.fails(shorter):
                    script = shorter
                else:
                    start += size
            size //= 2
        return script

    def without(self, script, path):
        smaller = json.loads(json.dumps(script))
        try:
            parent = at(smaller, path[:-1])
            del parent[path[-1]]
        except (KeyError, IndexError, TypeError):
            return script  # it went with something else
        return smaller if self.fails(smaller) else script

    def rounded(self, script, path):
        value = at(script, path)
        for digits in (1, 2, 3):
            simple = float(f"{value:.{digits}g}")
            simple = int(simple) if simple == int(simple) else simple
            if simple == value:
                return script
            smaller = json.loads(json.dumps(script))
            at(smaller, path[:-1])[path[-1]] = simple
            if self.fails(smaller):
                return smaller
        return script


def at(tree, path):
    for key in path:
        tree = tree[key]
    return tree


def path_key(path):
    # Last elements of lists first, so that the places of the others stay true.
    return [(-key, "") if isinstance(key, int) else (0, key) for key in path]


def walk(tree, path=()):
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in items:
        yield (*path, key), value
        yield from walk(value, (*path, key))


def places(script):
    """What can be left out: keys of the scene and elements of its lists, but for parts of vectors."""
    return [(0, *path) for path, value in walk(script[0])
            if not (isinstance(path[-1], int) and not isinstance(value, dict))]


def numbers(script):
    return [path for path, value in walk(script)
            if isinstance(value, float) or (isinstance(value, int) and not isinstance(value, bool))]


def main():
    program, name, text = sys.argv[1:]
    with open(name, encoding="utf-8") as file:
        script = json.load(file)
    reducer = Reducer(program, text)
    if not reducer.fails(script):
        sys.exit(f"the output of {name} does not have: {text}")
    print(json.dumps(reducer.reduced(script)))
    print(f"{reducer.tries} tries", file=sys.stderr)


if __name__ == "__main__":
    main()
