# SPDX-License-Identifier: Apache-2.0
# The parts of tools/report that need no package, where there is a Python: nothing else in the project needs one.
find_program(HELIO_PYTHON3 python3)
if(HELIO_PYTHON3)
    add_test(NAME Report.PlainPython COMMAND ${HELIO_PYTHON3} ${CMAKE_SOURCE_DIR}/tools/report/test_report.py)
    set_tests_properties(Report.PlainPython PROPERTIES LABELS "unit")
endif()
