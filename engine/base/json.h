#pragma once
// JSON from strangers and for anybody: parsers and printers recurse, and texts may hold any bytes.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "engine/base/error.h"

constexpr size_t MAX_JSON_DEPTH = 128; // glTF itself needs about 10

void checkJsonDepth(std::string_view text);                   // throws Error
std::string reasonOf(const nlohmann::json::exception& error); // why, for a sentence

// Throws Error: no JSON, or nested too deep. A zero byte is none, nor the end of the text, as the parser takes it.
template <class Json = nlohmann::ordered_json>
Json parseJson(std::span<const std::byte> bytes)
{
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    checkJsonDepth(text);
    if (const size_t zero = text.find('\0'); zero != text.npos)
        throw Error("The JSON is malformed: there is a zero byte at position {} of {}.", zero, text.size());
    try {
        return Json::parse(text);
    } catch (const nlohmann::json::exception& error) {
        throw Error("The JSON is malformed: {}.", reasonOf(error));
    }
}

// Names of files and scenes need not be UTF-8, but JSON is: what is not becomes U+FFFD. `indent`: -1 for one line.
inline std::string jsonText(const nlohmann::ordered_json& json, int indent = -1)
{
    return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}
