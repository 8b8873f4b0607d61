#include "tests/support/trichrome.h"

#include "engine/gpu/gpu.h"

#include <algorithm>
#include <cstdlib>

namespace
{

// It lies beside the tests' own executables.
std::filesystem::path executable(const std::string& name)
{
    return std::filesystem::read_symlink("/proc/self/exe").replace_filename(name);
}

const std::filesystem::path MPIRUN = "/usr/bin/mpirun";

bool isIn(const std::vector<std::string>& words, const std::string& word)
{
    return std::ranges::find(words, word) != words.end();
}

// Commands that take --device get it.
std::vector<std::string> onDevice(std::vector<std::string> arguments, const std::string& device)
{
    if (arguments.size() > 1 && arguments[0] != "compare" && !isIn(arguments, "--device") && !isIn(arguments, "--help"))
        arguments.insert(arguments.end(), {"--device", device});
    return arguments;
}

} // namespace

std::string Trichrome::deviceName()
{
    const char* wanted = std::getenv("TRICHROME_TEST_DEVICE");
    return wanted ? wanted : "llvmpipe";
}

Outcome Trichrome::run(std::vector<std::string> arguments, std::chrono::milliseconds signalAfter, int signal,
                       const std::string& program)
{
    return runProgram(
        executable(program),
        {.arguments = onDevice(std::move(arguments), deviceName()), .signalAfter = signalAfter, .signal = signal});
}

std::string Trichrome::missingForRanks()
{
    if (std::filesystem::exists(executable("trichrome-mpi")) && std::filesystem::exists(MPIRUN)) return "";
    return "SKIPPED, SEVERAL RANKS NOT TESTED: there is no trichrome-mpi or no mpirun (Debian packages "
           "libopenmpi-dev, openmpi-bin)";
}

Outcome Trichrome::runRanks(int count, const std::vector<std::string>& arguments,
                            const std::vector<std::string>& another)
{
    std::vector<std::string> words = {"--allow-run-as-root", "--oversubscribe"};
    const auto add = [&](int processes, const std::vector<std::string>& more) {
        words.insert(words.end(), {"-n", std::to_string(processes), executable("trichrome-mpi").string()});
        for (const std::string& word : onDevice(more, deviceName())) words.push_back(word);
    };
    add(count, arguments);
    if (!another.empty()) {
        words.emplace_back(":");
        add(1, another);
    }
    return runProgram(MPIRUN, {.arguments = words});
}

Outcome Trichrome::runWell(const std::vector<std::string>& arguments)
{
    Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_EQ(outcome.err, "");
    return outcome;
}

void Trichrome::expectRefusal(const std::vector<std::string>& arguments, int exitCode, const std::string& part)
{
    const Outcome outcome = run(arguments);
    std::string line;
    for (const std::string& word : arguments) line += word + " ";
    SCOPED_TRACE(line + "\n" + outcome.err);
    EXPECT_EQ(outcome.exitCode, exitCode);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(part), std::string::npos) << "expected: " << part;
    EXPECT_EQ(outcome.err.find("terminate"), std::string::npos);
}

void Trichrome::SetUp()
{
    for (const gpu::Adapter& adapter : gpu::enumerateAdapters())
        if (adapter.name.find(deviceName()) != std::string::npos) return;
    GTEST_SKIP() << "SKIPPED, COMMANDS NOT TESTED: there is no Vulkan device " << deviceName()
                 << " (Debian package mesa-vulkan-drivers)";
}
