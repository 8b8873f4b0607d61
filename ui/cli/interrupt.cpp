#include "ui/cli/interrupt.h"

#include <csignal>
#include <unistd.h>

namespace ui
{

namespace
{

volatile std::sig_atomic_t requestCount = 0;

extern "C" void onInterrupt(int)
{
    if (requestCount > 0) _exit(EXIT_INTERRUPTED);
    requestCount = 1;
}

} // namespace

Interrupt::Interrupt()
{
    requestCount = 0;
    std::signal(SIGINT, onInterrupt);
}

Interrupt::~Interrupt()
{
    std::signal(SIGINT, SIG_DFL);
}

bool Interrupt::requested() const
{
    return requestCount > 0;
}

} // namespace ui
