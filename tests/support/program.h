#pragma once
// Runs the built executable as a person would: arguments in; exit code, output and files out.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

struct Outcome {
    int exitCode = 0; // 128 + signal when one ended it, as shells report it
    std::string out;
    std::string err;
};

struct Launch {
    std::vector<std::string> arguments;
    std::chrono::milliseconds signalAfter{0}; // above 0: the signal is sent then
    int signal = SIGINT;                      // as Ctrl-C sends it
};
Outcome runProgram(const std::filesystem::path& program, const Launch& launch);

// A directory of its own, removed at the end.
class TemporaryDirectory
{
  public:
    TemporaryDirectory();
    ~TemporaryDirectory();
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    std::string path() const { return path_.string(); }
    std::vector<std::string> entries() const; // names, sorted

  private:
    std::filesystem::path path_;
};

void writeFile(const std::filesystem::path& file, const std::string& text);
std::string readFile(const std::filesystem::path& file);
nlohmann::json readJson(const std::filesystem::path& file);
