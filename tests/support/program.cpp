#include "tests/support/program.h"

#include "engine/base/error.h"
#include "engine/base/files.h"

#include <algorithm>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

Outcome runProgram(const std::filesystem::path& program, const Launch& launch)
{
    const TemporaryDirectory directory;
    const std::string outFile = directory / "out", errFile = directory / "err";
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    constexpr int FLAGS = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, outFile.c_str(), FLAGS, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errFile.c_str(), FLAGS, 0600);

    // A shell's "&" makes what it starts ignore Ctrl-C, nohup that the terminal is gone, and a child inherits that:
    // here each can be interrupted.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t heeded;
    sigemptyset(&heeded);
    for (const int signal : {SIGINT, SIGHUP}) sigaddset(&heeded, signal);
    posix_spawnattr_setsigdefault(&attributes, &heeded);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);

    std::vector<std::string> words = launch.arguments;
    words.insert(words.begin(), program.string());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    pid_t child = 0;
    const int failure = posix_spawn(&child, program.c_str(), &actions, &attributes, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (failure != 0) throw Error("Cannot run \"{}\" (errno {}).", program.string(), failure);
    if (launch.signalAfter.count() > 0) {
        std::this_thread::sleep_for(launch.signalAfter);
        kill(child, launch.signal);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return {.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            .out = readFile(outFile),
            .err = readFile(errFile)};
}

TemporaryDirectory::TemporaryDirectory()
{
    std::string name = (std::filesystem::temp_directory_path() / "trichrome_test_XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error("Cannot make a temporary directory \"{}\".", name);
    path_ = name;
}

TemporaryDirectory::~TemporaryDirectory()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryDirectory::entries() const
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
}

void writeFile(const std::filesystem::path& file, const std::string& text)
{
    std::ofstream(file) << text;
}

std::string readFile(const std::filesystem::path& file)
{
    const std::vector<std::byte> bytes = files::read(file);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

nlohmann::json readJson(const std::filesystem::path& file)
{
    return nlohmann::json::parse(readFile(file));
}
