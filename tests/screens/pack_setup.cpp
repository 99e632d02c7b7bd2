// SPDX-License-Identifier: Apache-2.0
// Bakes the packs of the picture tests: ctest runs it once, before the first of them.
#include <iostream>

#include "tests/screens/test_packs.h"

int main()
{
    const helio::Status baked = helio::bakeTestPacks();
    if (!baked) std::cerr << baked.error().message << std::endl;
    return baked ? 0 : 1;
}
