"""Lists the tests that skipped themselves for missing files, as a filter of nextest.

Usage: skipped.py JUNIT.XML

Such a test prints a line that begins with "skipped: ".
"""

import sys
from xml.etree import ElementTree


def skipped(report):
    """The names of the tests of a JUnit report that printed that they were skipped.

    >>> skipped(ElementTree.fromstring('''<testsuites><testsuite>
    ...     <testcase name="a"><system-err>skipped: a: no file</system-err></testcase>
    ...     <testcase name="b::c"><system-out>5 skipped: none</system-out></testcase>
    ... </testsuite></testsuites>'''))
    ['a']
    """
    cases = report.iter("testcase")
    lines = {case.get("name"): "\n".join(case.itertext()).splitlines() for case in cases}
    return [name for name, printed in lines.items() if any(line.strip().startswith("skipped: ") for line in printed)]


if __name__ == "__main__":
    print(" + ".join(f"test(={name})" for name in skipped(ElementTree.parse(sys.argv[1]))))
