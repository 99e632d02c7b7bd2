# SPDX-License-Identifier: Apache-2.0
"""The curves of an earlier prototype on S and M: what the curves here are to be at least as good as. Links per patch, then
E_indirect rms in % for suns A, B, C and sky; references, metrics and scenes are those of the report, direct light was given."""

PROTOTYPE = {
    "S": {
        "prototype, linear, one-sided": ((9.8, 3.8, 4.1, 5.3, 2.4), (20.3, 1.08, 1.15, 2.10, .63), (32.3, .84, .92, 1.93, .46),
                                         (50.8, .81, .86, 1.89, .43), (64.0, .79, .86, 1.88, .42), (101, .80, .85, 1.88, .42),
                                         (144, .80, .85, 1.88, .42)),
        "prototype, linear, two-sided": ((3.3, 3.9, 3.9, 5.5, 2.8), (6.9, 2.1, 2.3, 3.7, 1.7), (14.4, 1.18, 1.28, 2.29, .82),
                                         (25.8, .96, .99, 2.06, .64), (35.7, .95, .94, 2.05, .65)),
    },
    "M": {
        "prototype, linear, one-sided": ((30.4, 2.23, 2.91, 2.96, 1.32), (39.4, 1.38, 2.09, 1.90, .69),
                                         (50.8, 1.20, 1.91, 1.70, .53), (64.0, 1.16, 1.85, 1.67, .48),
                                         (104, 1.13, 1.77, 1.65, .42), (201, 1.12, 1.75, 1.65, .42)),
        "prototype, linear, two-sided": ((4.2, 5.0, 5.5, 5.7, 3.8), (8.7, 2.7, 3.2, 3.4, 2.0), (19.0, 1.63, 2.10, 2.22, 1.04),
                                         (29.4, 1.38, 1.85, 1.96, .80), (45.3, 1.37, 1.84, 1.97, .83)),
    },
}
CASE_COLUMN = {"A": 1, "B": 2, "C": 3, "sky": 4}


def best_of_prototype(scene, case):
    """The lower envelope of the prototype's curves: [(links per patch, rms as a fraction)], rms falling."""
    points = sorted((row[0], row[CASE_COLUMN[case]] / 100) for rows in PROTOTYPE.get(scene, {}).values() for row in rows)
    envelope, least = [], float("inf")
    for links, rms in points:
        if rms < least:
            least = rms
            envelope.append((links, rms))
    return envelope
