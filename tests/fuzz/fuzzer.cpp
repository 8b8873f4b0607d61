// libFuzzer's entry: TRICHROME_FUZZ names the target (targets.h), TRICHROME_FUZZ_SEEDS a folder that gets its seeds.
// Started by ./run fuzz (tests/fuzz/fuzz.py).

#include "tests/fuzz/targets.h"

#include "tests/support/program.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace
{

const fuzz::Target* chosen = nullptr;

std::string variable(const char* name)
{
    const char* value = std::getenv(name);
    return value ? value : "";
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
    for (const fuzz::Target& target : fuzz::targets())
        if (target.name == variable("TRICHROME_FUZZ")) chosen = &target;
    if (!chosen) {
        std::fprintf(stderr, "fuzzer: TRICHROME_FUZZ names no target\n");
        std::exit(2);
    }
    int number = 0;
    for (const std::vector<std::byte>& seed : fuzz::seeds(chosen->name))
        writeFile(variable("TRICHROME_FUZZ_SEEDS") + "/seed" + std::to_string(number++),
                  {reinterpret_cast<const char*>(seed.data()), seed.size()});
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    chosen->run(std::as_bytes(std::span(data, size)));
    return 0;
}
