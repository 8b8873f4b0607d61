#pragma once
// Ctrl-C during long work: finish cleanly, keep what there is.

namespace ui
{

constexpr int EXIT_INTERRUPTED = 130; // 128 + SIGINT, as shells report it

// While one exists, the first Ctrl-C only sets a flag; the second one ends the program at once.
class Interrupt
{
  public:
    Interrupt();
    ~Interrupt(); // the default again
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    bool requested() const;
};

} // namespace ui
