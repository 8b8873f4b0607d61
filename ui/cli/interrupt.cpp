#include "ui/cli/interrupt.h"

#include <csignal>
#include <unistd.h>

namespace ui
{

namespace
{

constexpr int SIGNALS[] = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t received = 0;

extern "C" void onSignal(int signal)
{
    if (received != 0) _exit(128 + signal);
    received = signal;
}

} // namespace

Interrupt::Interrupt()
{
    received = 0;
    for (const int signal : SIGNALS)
        if (std::signal(signal, onSignal) == SIG_IGN && signal == SIGHUP) std::signal(signal, SIG_IGN); // nohup
}

Interrupt::~Interrupt()
{
    for (const int signal : SIGNALS)
        if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
}

int Interrupt::exitCode()
{
    return received == 0 ? 0 : 128 + received;
}

} // namespace ui
