// trichrome: one process.

#include "ui/cli/ranks.h"

namespace ui
{

const Ranks& ranks()
{
    static const Ranks ALONE;
    return ALONE;
}

} // namespace ui
