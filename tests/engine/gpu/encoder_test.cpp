// Order of dependent work without a word about barriers. Synchronization validation must be silent in all of these.

#include "engine/base/error.h"
#include "tests/support/gpu_fixture.h"

#include <numeric>

namespace
{

using Words = std::vector<uint32_t>;
constexpr uint32_t COUNT = 4096;
constexpr uint32_t STRIDE = 1031; // coprime to COUNT, far beyond a workgroup
constexpr uint32_t INCREMENT = 3;

class Encoder : public GpuTest
{
  protected:
    void SetUp() override
    {
        GpuTest::SetUp();
        if (IsSkipped()) return;
        step_ = upload("step", Words{STRIDE, INCREMENT}, gpu::Usage::Uniform);
        kernel_ = device().createComputePipeline({.label = "step", .shader = TEST_SPIRV_DIR "/encoder_test"});
        frame_ =
            device().createBindGroup({.label = "frame", .pipeline = &kernel_, .set = 0, .buffers = {{"Step", &step_}}});
    }

    gpu::BindGroup pass(const gpu::Buffer& from, const gpu::Buffer& to)
    {
        return device().createBindGroup({.label = from.label() + " to " + to.label(),
                                         .pipeline = &kernel_,
                                         .set = 2,
                                         .buffers = {{"From", &from}, {"To", &to}}});
    }
    void step(gpu::CommandEncoder& encoder, const gpu::BindGroup& group, uint32_t threads = COUNT)
    {
        encoder.dispatch({.pipeline = &kernel_, .groups = {&frame_, nullptr, &group}, .threads = {threads}});
    }

    static Words start()
    {
        Words values(COUNT);
        std::iota(values.begin(), values.end(), 100u);
        return values;
    }
    static Words after(uint32_t steps) // what `steps` steps make of start()
    {
        Words values(COUNT);
        for (uint32_t i = 0; i < COUNT; ++i) values[i] = (i + steps * STRIDE) % COUNT + 100 + steps * INCREMENT;
        return values;
    }

    gpu::Buffer step_;
    gpu::ComputePipeline kernel_;
    gpu::BindGroup frame_;
};

TEST_F(Encoder, RunsDependentDispatchesInOrder)
{
    const gpu::Buffer a = upload("a", start());
    const gpu::Buffer b = create<uint32_t>("b", COUNT);
    const gpu::BindGroup forth = pass(a, b);
    const gpu::BindGroup back = pass(b, a);
    gpu::CommandEncoder encoder = device().createCommandEncoder("chain");
    for (int i = 0; i < 20; ++i) step(encoder, i % 2 == 0 ? forth : back);
    device().queue().submit(std::move(encoder));
    EXPECT_EQ(download<uint32_t>(a), after(20));
    EXPECT_EQ(download<uint32_t>(b), after(19));
}

TEST_F(Encoder, RunsDependentSubmissionsInOrderWithoutWaiting)
{
    const gpu::Buffer a = upload("a", start());
    const gpu::Buffer b = create<uint32_t>("b", COUNT);
    const gpu::BindGroup forth = pass(a, b);
    const gpu::BindGroup back = pass(b, a);
    for (int i = 0; i < 20; ++i) {
        gpu::CommandEncoder encoder = device().createCommandEncoder("link");
        step(encoder, i % 2 == 0 ? forth : back);
        device().queue().submit(std::move(encoder));
    }
    EXPECT_EQ(download<uint32_t>(a), after(20));
}

TEST_F(Encoder, RunsInterleavedIndependentChains)
{
    std::vector<gpu::Buffer> a, b;
    std::vector<gpu::BindGroup> forth, back;
    for (int chain = 0; chain < 3; ++chain) {
        a.push_back(upload("a" + std::to_string(chain), start()));
        b.push_back(create<uint32_t>("b" + std::to_string(chain), COUNT));
    }
    for (size_t chain = 0; chain < 3; ++chain) {
        forth.push_back(pass(a[chain], b[chain]));
        back.push_back(pass(b[chain], a[chain]));
    }
    gpu::CommandEncoder encoder = device().createCommandEncoder("chains");
    for (size_t i = 0; i < 6; ++i)
        for (size_t chain = 0; chain <= 2; ++chain)
            if (i < 2 * (chain + 1)) step(encoder, i % 2 == 0 ? forth[chain] : back[chain]);
    device().queue().submit(std::move(encoder));
    for (uint32_t chain = 0; chain < 3; ++chain) EXPECT_EQ(download<uint32_t>(a[chain]), after(2 * (chain + 1)));
}

TEST_F(Encoder, OrdersCopiesAndClearsAmongDispatches)
{
    const gpu::Buffer a = upload("a", start());
    const gpu::Buffer b = create<uint32_t>("b", COUNT);
    const gpu::Buffer c = create<uint32_t>("c", COUNT);
    const gpu::BindGroup aToB = pass(a, b);
    const gpu::BindGroup cToA = pass(c, a);
    gpu::CommandEncoder encoder = device().createCommandEncoder("mixed");
    step(encoder, aToB);
    encoder.copy(b, c);  // reads what the dispatch wrote
    encoder.clear(b, 7); // writes what the copy read
    step(encoder, cToA); // reads what the copy wrote, writes what the first dispatch read
    encoder.copy(a, c, 16, 0, 32);
    device().queue().submit(std::move(encoder));
    EXPECT_EQ(download<uint32_t>(a), after(2));
    EXPECT_EQ(download<uint32_t>(b), Words(COUNT, 7));
    Words expected = after(1);
    std::copy_n(after(2).begin(), 4, expected.begin() + 8);
    EXPECT_EQ(download<uint32_t>(c), expected);
}

TEST_F(Encoder, ADispatchOfNoThreadsDoesNothing)
{
    const gpu::Buffer a = upload("a", start());
    const gpu::Buffer b = create<uint32_t>("b", COUNT);
    const gpu::BindGroup forth = pass(a, b);
    gpu::CommandEncoder encoder = device().createCommandEncoder("none");
    step(encoder, forth, 0);
    device().queue().submit(std::move(encoder));
    EXPECT_EQ(download<uint32_t>(b), Words(COUNT, 0));
}

TEST_F(Encoder, TooManyWorkgroupsIsAnErrorThatNamesTheSetting)
{
    const gpu::Buffer a = upload("a", start());
    const gpu::Buffer b = create<uint32_t>("b", COUNT);
    const gpu::BindGroup forth = pass(a, b);
    gpu::CommandEncoder encoder = device().createCommandEncoder("huge");
    try {
        encoder.dispatch({.pipeline = &kernel_,
                          .groups = {&frame_, nullptr, &forth},
                          .threads = {1, ~0u},
                          .label = "everything",
                          .setting = "--size"});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("\"everything\" needs 4294967295 workgroups along y"),
                  std::string::npos)
            << error.what();
        EXPECT_NE(std::string(error.what()).find("reduce --size"), std::string::npos) << error.what();
    }
}

TEST_F(Encoder, OneThatIsNeverSubmittedLeavesNoTrace)
{
    const gpu::Buffer a = upload("a", start());
    for (int i = 0; i < 3; ++i) {
        gpu::CommandEncoder abandoned = device().createCommandEncoder("abandoned");
        abandoned.clear(a, 1);
    }
    gpu::CommandEncoder encoder = device().createCommandEncoder("empty");
    device().queue().submit(std::move(encoder));
    EXPECT_EQ(download<uint32_t>(a), start());
}

} // namespace
