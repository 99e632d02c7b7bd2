// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include "engine/gpu/context.h"

namespace helio {

/// Base of every test that uses a device: one context for the whole executable, with validation and synchronisation
/// validation. Any message of the validation layer fails the test in which it appears. HELIO_DEVICE picks the device.
class GpuTest : public testing::Test
{
protected:
    static void SetUpTestSuite();
    void SetUp() override;
    void TearDown() override;

    /// The shared context; no device fails the test.
    Context& context();
    /// For tests that plant a mistake: the messages so far, which then no longer fail the test.
    std::vector<std::string> takeMessages();
};

} // namespace helio
