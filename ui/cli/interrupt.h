#pragma once
// Ctrl-C during long work, or a request to end (SIGTERM: Slurm, containers): finish cleanly, keep what there is.

namespace ui
{

// While one exists, the first of SIGINT, SIGTERM and SIGHUP (the terminal is gone) only sets a flag; the second one
// ends the program at once.
class Interrupt
{
  public:
    Interrupt();
    ~Interrupt(); // the defaults again
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    bool requested() const { return exitCode() != 0; }

    // 128 + the signal's number, as shells report it: 130 for Ctrl-C, 143 for SIGTERM. 0: none came.
    static int exitCode();
};

} // namespace ui
