// trichrome: one process.

#include "ui/cli/ranks.h"

namespace ui
{

namespace
{

class Alone : public Ranks
{
  public:
    uint32_t index() const override { return 0; }
    uint32_t count() const override { return 1; }
    void barrier() const override {}
    std::vector<Bytes> gather(const std::vector<Bytes>& records) const override { return records; }
    int finish(int exitCode) const override { return exitCode; }
};

} // namespace

const Ranks& ranks()
{
    static const Alone ALONE;
    return ALONE;
}

} // namespace ui
