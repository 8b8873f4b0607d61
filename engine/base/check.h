#pragma once
// CHECK: logic errors, always on in host code. Prints file, expression and both values, then aborts.

#include <cstdio>
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <fmt/ostream.h>

[[noreturn]] inline void checkFailed(const char* file, int line, const std::string& message)
{
    std::fprintf(stderr, "%s:%d: internal error: %s\n", file, line, message.c_str());
    std::abort();
}

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) checkFailed(__FILE__, __LINE__, "CHECK(" #condition ")");                                    \
    } while (false)

#define CHECK_OP_(a, op, b)                                                                                            \
    do {                                                                                                               \
        const auto& checkLeft = (a);                                                                                   \
        const auto& checkRight = (b);                                                                                  \
        if (!(checkLeft op checkRight))                                                                                \
            checkFailed(__FILE__, __LINE__,                                                                            \
                        fmt::format("{} " #op " {} ({} against {})", #a, #b, checkLeft, checkRight));                  \
    } while (false)

#define CHECK_EQ(a, b) CHECK_OP_(a, ==, b)
#define CHECK_LE(a, b) CHECK_OP_(a, <=, b)
#define CHECK_LT(a, b) CHECK_OP_(a, <, b)
