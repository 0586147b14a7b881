# SPDX-License-Identifier: GPL-3.0-or-later
"""The JSON text of reports: compact, and unchanged when read back."""

import json

from hypothesis import given
from hypothesis import strategies as st

from stiv.json_files import json_text

PLAIN = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text()
ANYTHING = st.recursive(PLAIN, lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner), max_leaves=30)


@given(ANYTHING)
def test_it_is_unchanged_when_read_back(data):
    assert json.loads(json_text(data)) == data


def test_a_list_of_numbers_takes_one_line():
    text = json_text({"rows": [{"times": [1, 2.5, 3]}, {"times": []}], "name": "ü"})
    assert text.splitlines() == [
        "{",
        '  "rows": [',
        "    {",
        '      "times": [1, 2.5, 3]',
        "    },",
        "    {",
        '      "times": []',
        "    }",
        "  ],",
        '  "name": "ü"',
        "}",
    ]
