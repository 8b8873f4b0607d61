#pragma once
// The real stages that resample, run on a world whose integrals are known in closed form (tests/shaders/toy/toy.h).

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/gpu/gpu.h"
#include "engine/image/image.h"
#include "passes/estimator.h"
#include "passes/settings.h"
#include "tests/support/restir_cases.h"
#include "tests/support/tile_tests.h"

namespace support
{

struct ToyCase {
    Reuse reuse = Reuse::Both;
    bool moves = false; // domains change from frame to frame, and are seen by other pixels
    uint32_t maxConfidence = 1;
    uint32_t frames = 6;        // rendered; the last one counts
    uint32_t runs = UINT32_MAX; // of the renderer's, at most; a multiple of shared::TOY_GROUP
    uint64_t seed = 1;
    uint32_t colorConfidence = 1048576; // of Color::Variate

    std::string name() const;
};

class ToyRenderer
{
  public:
    // `shaders` is put before the stages' names. All `runs` share a dispatch; a multiple of shared::TOY_GROUP.
    ToyRenderer(gpu::Device& device, const std::string& shaders, const passes::Estimator& estimator,
                passes::Shift shift, uint32_t runs, passes::Color color = passes::Color::Chosen,
                passes::Mutate mutate = passes::Mutate::Off);

    // The mean over each group of runs of the last frame, without what is seen directly. With `elides`, the stage for
    // resting cameras is used where nothing moves. A value that is not finite fails the test.
    std::vector<image::Image> render(const ToyCase& c, bool elides = true);

    // Are the means the integrals? Tile by tile and as a whole, each at the level, and as a whole within the margin.
    TileVerdict verdict(const ToyCase& c, double level, double margin);

  private:
    struct Stage {
        gpu::ComputePipeline pipeline;
        gpu::BindGroup frame, own;
    };
    Stage& stage(const std::string& name, bool sameView);

    gpu::Device& device_;
    std::string shaders_;
    std::vector<gpu::Constant> constants_;
    passes::Estimator estimator_;
    uint32_t runs_;
    bool mutates_;
    std::map<std::string, gpu::Buffer> buffers_;
    std::map<std::pair<std::string, bool>, Stage> stages_;
};

} // namespace support
