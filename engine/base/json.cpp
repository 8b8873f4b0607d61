#include "engine/base/json.h"

#include "engine/base/shown.h"

#include <algorithm>

void checkJsonDepth(std::string_view text)
{
    size_t depth = 0;
    bool inString = false;
    for (size_t i = 0; i < text.size(); ++i) {
        if (inString) {
            if (text[i] == '\\')
                ++i;
            else if (text[i] == '"')
                inString = false;
        } else if (text[i] == '"') {
            inString = true;
        } else if (text[i] == '[' || text[i] == '{') {
            if (++depth > MAX_JSON_DEPTH) throw Error("The JSON is nested deeper than {} levels.", MAX_JSON_DEPTH);
        } else if ((text[i] == ']' || text[i] == '}') && depth > 0) {
            --depth;
        }
    }
}

std::string reasonOf(const nlohmann::json::exception& error)
{
    const std::string reason = error.what(); // "[json.exception.parse_error.101] parse error at line 1, ..."
    return shown(reason.substr(std::min(reason.find("] ") + 2, reason.size())), 200);
}
