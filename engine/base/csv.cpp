#include "engine/base/csv.h"

#include "engine/base/check.h"

Csv::Csv(const std::vector<std::string>& columns) : columnCount_(columns.size())
{
    line(columns);
}

void Csv::row(const std::vector<std::string>& cells)
{
    CHECK_EQ(cells.size(), columnCount_);
    line(cells);
}

void Csv::line(const std::vector<std::string>& cells)
{
    for (size_t i = 0; i < cells.size(); ++i) {
        if (i > 0) text_ += ',';
        if (cells[i].find_first_of(",\"\r\n") == std::string::npos) {
            text_ += cells[i];
            continue;
        }
        text_ += '"';
        for (const char c : cells[i]) text_ += c == '"' ? std::string("\"\"") : std::string(1, c);
        text_ += '"';
    }
    text_ += '\n';
}

std::string csvNumber(double value)
{
    return fmt::format("{}", value); // the shortest that reads back exactly
}
