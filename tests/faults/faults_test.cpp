// A render whose world fails at one point, for every point: it recovers, or ends with one sentence and exit code 1;
// files are whole or as before, and nothing else is left. The points: tests/faults/faulty_calls.cpp.

#include "tests/support/trichrome.h"

#include "engine/gpu/gpu.h"
#include "engine/image/image.h"
#include "passes/checkpoint.h"

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <vulkan/vulkan_core.h>

namespace
{

// Every point, of ReSTIR too, instead of the middle one of each call.
bool wantsAll()
{
    return std::getenv("TRICHROME_TEST_ALL_FAULTS") != nullptr;
}

class ScopedVariable
{
  public:
    ScopedVariable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
    ~ScopedVariable() { unsetenv(name_); }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

  private:
    const char* name_;
};

class Faults : public Trichrome
{
  protected:
    Outcome render(const std::string& method) const
    {
        return run({"render", "cornell", "-o", picture, "--size", "16x9", "--frames", "2", "--max-bounces", "1",
                    "--method", method, "--stats", stats, "--checkpoint", checkpoint, "--checkpoint-interval", "0"},
                   {}, SIGINT, "trichrome_faulty");
    }

    // What a call fails with the n-th time, one kind after the other where there are several.
    static int codeOf(const std::string& call, long number)
    {
        if (call.starts_with("vkCreate") || call.starts_with("vkAllocate"))
            return number % 2 == 1 ? VK_ERROR_OUT_OF_DEVICE_MEMORY : VK_ERROR_OUT_OF_HOST_MEMORY;
        if (call == "vkQueueSubmit" || call == "vkWaitSemaphores" || call.starts_with("vkGet"))
            return VK_ERROR_DEVICE_LOST;
        if (call.starts_with("vk")) return VK_ERROR_OUT_OF_HOST_MEMORY;
        return call == "open" || call == "fopen" ? EACCES : ENOSPC;
    }

    static std::set<long> numbersOf(const std::string& call, long count)
    {
        std::set<long> numbers;
        if (call == "_Znwm") // tens of thousands
            for (double n = 1; n <= double(count); n *= wantsAll() ? 1.05 : 20) numbers.insert(long(n));
        else if (wantsAll())
            for (long n = 1; n <= count; ++n) numbers.insert(n);
        else
            numbers = {(count + 1) / 2};
        return numbers;
    }

    void expectSanity(const Outcome& outcome, const std::string& whole) const
    {
        if (outcome.exitCode == 0) {
            EXPECT_EQ(readFile(picture), whole); // recovered
        } else {
            EXPECT_EQ(outcome.exitCode, 1);
            EXPECT_TRUE(outcome.err.starts_with("trichrome: ") || outcome.err.starts_with("Warning: ")) << outcome.err;
            EXPECT_TRUE(outcome.err.ends_with(".\n")) << outcome.err;
            const std::string now = readFile(picture);
            EXPECT_TRUE(now == "before" || now == whole);
        }
        if (readFile(stats) != "before") {
            EXPECT_NO_THROW(readJson(stats));
        }
        if (readFile(checkpoint) != "before") {
            EXPECT_NO_THROW(passes::readCheckpoint(checkpoint));
        }
        EXPECT_EQ(directory.entries(), (std::vector<std::string>{"cache", "calls", "out.exr", "stats.json", "x.ckpt"}));
    }

    const std::string picture = directory / "out.exr", stats = directory / "stats.json",
                      checkpoint = directory / "x.ckpt", calls = directory / "calls";
};

} // namespace

TEST_F(Faults, EndInOneSentenceOrARecoveryWithEveryFileWhole)
{
    const ScopedVariable cache("XDG_CACHE_HOME", directory / "cache");
    std::map<std::string, int> outcomes;
    for (const std::string method : wantsAll() ? std::vector{"pt", "rgb-restir"} : std::vector{"pt"}) {
        ASSERT_EQ(render(method).exitCode, 0); // fills the pipeline cache
        const ScopedVariable counting("TRICHROME_CALLS", calls);
        ASSERT_EQ(render(method).exitCode, 0);
        const std::string whole = readFile(picture);
        std::map<std::string, long> counts;
        std::ifstream list(calls);
        for (std::string call; list >> call;) list >> counts[call];
        EXPECT_GT(counts.size(), 25u);
        for (const auto& [call, count] : counts)
            for (const long number : numbersOf(call, count)) {
                const std::string fault = fmt::format("{}:{}:{}", call, number, codeOf(call, number));
                for (const std::string& file : {picture, stats, checkpoint, calls}) writeFile(file, "before");
                const ScopedVariable plan("TRICHROME_FAULT", fault);
                const Outcome outcome = render(method);
                SCOPED_TRACE(method + " " + fault + "\n" + outcome.err);
                expectSanity(outcome, whole);
                ++outcomes[outcome.exitCode == 0 ? "recovered" : "ended in a sentence"];
            }
    }
    for (const auto& [outcome, count] : outcomes) std::printf("%d faults %s\n", count, outcome.c_str());
}

// A CPU's driver promises memory that the system lacks, and the process is killed when it uses it. Buffers of a larger
// picture than that of the test above are asked for.
TEST_F(Faults, OfMemoryThatTheSystemLacksAreToldBeforeTheDriverPromisesIt)
{
    for (const gpu::Adapter& adapter : gpu::enumerateAdapters())
        if (adapter.name.find(deviceName()) != std::string::npos && adapter.kind != "cpu")
            GTEST_SKIP() << "SKIPPED, NOT TESTED: a graphics card has memory of its own";
    const ScopedVariable plan("TRICHROME_FAULT", "_ZN6memory14availableBytesEv:1:0");
    const Outcome outcome = run({"render", "cornell", "-o", picture, "--size", "1024x1024", "--frames", "1"}, {},
                                SIGINT, "trichrome_faulty");
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_TRUE(outcome.err.starts_with("trichrome: Buffer \"")) << outcome.err;
    EXPECT_NE(outcome.err.find(" does not fit into the memory of "), std::string::npos) << outcome.err;
    EXPECT_TRUE(outcome.err.ends_with("; reduce --size.\n")) << outcome.err;
    EXPECT_TRUE(directory.entries().empty());
}

TEST_F(Faults, CtrlCAtAnyMomentLeavesWholeFilesOrThoseBefore)
{
    for (const int milliseconds : {5, 40, 90, 170, 330, 600, 1100}) {
        for (const std::string& file : {picture, stats, checkpoint}) writeFile(file, "before");
        const Outcome outcome = run({"render", "cornell", "-o", picture, "--size", "32x18", "--frames", "1000000",
                                     "--stats", stats, "--checkpoint", checkpoint, "--checkpoint-interval", "0"},
                                    std::chrono::milliseconds(milliseconds));
        SCOPED_TRACE(fmt::format("after {} ms: {}", milliseconds, outcome.err));
        EXPECT_EQ(outcome.exitCode, 130);
        if (readFile(picture) != "before") {
            EXPECT_EQ(image::read(picture).image.pixels.size(), 32u * 18u);
        }
        if (readFile(stats) != "before") {
            EXPECT_EQ(readJson(stats)["partial"], true);
        }
        if (readFile(checkpoint) != "before") {
            EXPECT_GT(passes::readCheckpoint(checkpoint).state.frames, 0u);
        }
        EXPECT_EQ(directory.entries(), (std::vector<std::string>{"out.exr", "stats.json", "x.ckpt"}));
    }
}
