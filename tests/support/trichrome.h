#pragma once
// The fixture of tests that run the trichrome executable on the test device.

#include "tests/support/program.h"

#include <gtest/gtest.h>

class Trichrome : public testing::Test
{
  protected:
    static std::string deviceName(); // part of it, as --device takes

    // Adds --device to commands that take it. Sends the signal (default: Ctrl-C) after a time above 0.
    static Outcome run(std::vector<std::string> arguments, std::chrono::milliseconds signalAfter = {},
                       int signal = SIGINT, const std::string& program = "trichrome");

    // As several processes of MPI; `another` are the arguments of one more. Needs trichrome-mpi, which is built where
    // MPI is, and mpirun: what is missing of them, as a sentence.
    static std::string missingForRanks();
    static Outcome runRanks(int count, const std::vector<std::string>& arguments,
                            const std::vector<std::string>& another = {});

    // Expects exit code 0 and nothing on stderr.
    static Outcome runWell(const std::vector<std::string>& arguments);

    // Expects one sentence on stderr that contains `part`, nothing on stdout, and the exit code.
    static void expectRefusal(const std::vector<std::string>& arguments, int exitCode, const std::string& part);

    void SetUp() override; // skips when the device's driver is not installed

    TemporaryDirectory directory;
};
