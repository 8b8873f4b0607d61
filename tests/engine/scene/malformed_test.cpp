// Every file of ../shared/malformed loads or fails as its manifest says, in a child process of limited memory and time.
// Covers engine/base/shown.cpp, engine/scene/gltf_json.cpp, engine/scene/gltf_json_checks.cpp.

#include <csignal>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/image/image.h"
#include "engine/scene/environment.h"
#include "engine/scene/gltf_loader.h"
#include "tests/support/shared_files.h"

namespace
{

constexpr rlim_t EXTRA_MEMORY = rlim_t{512} << 20; // far more than any of the files can fill
constexpr unsigned MAX_SECONDS = 20;

struct Outcome {
    enum class Kind { Done, Failed, Died } kind = Kind::Died;
    std::string message; // the Error's, or how it died
};

void limitMemory()
{
#ifndef __SANITIZE_ADDRESS__ // whose shadow memory is a reservation of terabytes
    std::ifstream statm("/proc/self/statm");
    rlim_t pages = 0;
    statm >> pages;
    const rlim_t bytes = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + EXTRA_MEMORY;
    const rlimit limit = {bytes, bytes};
    setrlimit(RLIMIT_AS, &limit);
#endif
}

[[noreturn]] void runChild(const std::function<void()>& work, int answer)
{
    const rlimit noCore = {0, 0};
    setrlimit(RLIMIT_CORE, &noCore);
    limitMemory();
    alarm(MAX_SECONDS);
    std::string text = "D";
    try {
        work();
    } catch (const Error& error) {
        text = std::string("F") + error.what();
    } catch (const std::exception& exception) {
        text = std::string("X") + exception.what();
    }
    [[maybe_unused]] const ssize_t written = write(answer, text.data(), text.size());
    _exit(0);
}

Outcome runApart(const std::function<void()>& work)
{
    int ends[2];
    if (pipe(ends) != 0) return {Outcome::Kind::Died, "no pipe"};
    const pid_t child = fork();
    if (child == 0) runChild(work, ends[1]);
    close(ends[1]);
    std::string text;
    char buffer[4096];
    for (ssize_t got; (got = read(ends[0], buffer, sizeof buffer)) > 0;) text.append(buffer, static_cast<size_t>(got));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) return {Outcome::Kind::Died, strsignal(WTERMSIG(status))};
    if (text.starts_with('D')) return {Outcome::Kind::Done, ""};
    if (text.starts_with('F')) return {Outcome::Kind::Failed, text.substr(1)};
    return {Outcome::Kind::Died, "an exception that is no Error: " + text};
}

void load(const MalformedFile& file)
{
    if (file.kind == "image") {
        image::read(file.path);
    } else if (file.kind == "hdr") {
        scene::Scene scene;
        scene::setEnvironment(scene, file.path, 1);
    } else {
        scene::loadGltf(file.path);
    }
}

bool isOneSentence(const std::string& message)
{
    return message.ends_with('.') && message.size() > 20 && message.size() < 500 &&
           message.find('\n') == std::string::npos;
}

} // namespace

TEST(Malformed, FilesLoadOrFailAsTheManifestSays)
{
    SKIP_WITHOUT_SHARED("malformed/manifest.json");
    const bool verbose = std::getenv("TRICHROME_VERBOSE") != nullptr;
    const std::vector<MalformedFile> files = malformedFiles();
    ASSERT_GE(files.size(), 300u);
    for (const MalformedFile& file : files) {
        SCOPED_TRACE(file.path.filename().string() + ": " + file.why);
        const Outcome outcome = runApart([&] { load(file); });
        if (verbose) std::printf("%-40s %s\n", file.path.filename().c_str(), outcome.message.c_str());
        switch (outcome.kind) {
        case Outcome::Kind::Done: EXPECT_TRUE(file.mayLoad) << "it loaded"; break;
        case Outcome::Kind::Failed:
            EXPECT_TRUE(file.mayFail) << outcome.message;
            EXPECT_TRUE(isOneSentence(outcome.message)) << outcome.message;
            break;
        case Outcome::Kind::Died: ADD_FAILURE() << outcome.message; break;
        }
    }
}

// The limits of the test above do bite.
TEST(Malformed, TheTestSeesCrashesAndGreed)
{
    EXPECT_EQ(runApart([] { std::abort(); }).kind, Outcome::Kind::Died);
    EXPECT_EQ(runApart([] {}).kind, Outcome::Kind::Done);
#ifndef __SANITIZE_ADDRESS__
    EXPECT_EQ(runApart([] { std::vector<char> greedy(2 * EXTRA_MEMORY, 'x'); }).kind, Outcome::Kind::Died);
#endif
}
