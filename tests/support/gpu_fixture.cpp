// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gpu_fixture.h"

#include <dlfcn.h>

/// Read by LeakSanitizer, if the build has it: leaks inside the layer and the software driver are not ours to mend.
extern "C" const char* __lsan_default_suppressions()
{
    return "leak:libVkLayer_khronos_validation\nleak:libvulkan_lvp\nleak:libLLVM\n";
}

namespace helio {
namespace {

std::unique_ptr<Context> shared;
std::string whyNot = "not tried";

/// The loader unloads these with the last instance, and a leak in an unloaded library has no name to suppress it by.
void keepDriversLoaded()
{
    for (const char* library : {"libVkLayer_khronos_validation.so", "libvulkan_lvp.so"}) {
        dlopen(library, RTLD_NOLOAD | RTLD_NODELETE | RTLD_LAZY);
    }
}

/// Lets the device go while the driver's own static objects are still alive; what it says then (leaked objects) is a
/// failure.
class CloseDevice : public testing::Environment
{
public:
    void TearDown() override
    {
        if (!shared) return;
        shared->messages().clear();
        const std::shared_ptr<MessageLog> log = shared->sharedMessages();
        shared.reset();
        for (const std::string& message : log->all()) ADD_FAILURE() << message;
    }
};

// googletest owns it.
[[maybe_unused]] const testing::Environment* const closeDevice = testing::AddGlobalTestEnvironment(new CloseDevice);

} // namespace

void GpuTest::SetUpTestSuite()
{
    if (shared) return;
    ContextOptions options;
    options.validation = true;
    Result<std::unique_ptr<Context>> made = Context::create(options);
    if (!made) {
        whyNot = made.error().message;
        return;
    }
    shared = std::move(*made);
    keepDriversLoaded();
}

void GpuTest::SetUp()
{
    ASSERT_TRUE(shared) << whyNot;
    shared->messages().clear();
}

void GpuTest::TearDown()
{
    if (!shared) return;
    shared->waitIdle();
    for (const std::string& message : shared->messages().all()) ADD_FAILURE() << message;
}

Context& GpuTest::context()
{
    return *shared;
}

std::vector<std::string> GpuTest::takeMessages()
{
    std::vector<std::string> messages = shared->messages().all();
    shared->messages().clear();
    return messages;
}

} // namespace helio
