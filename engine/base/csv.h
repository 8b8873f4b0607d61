#pragma once
// Tables for other programs: RFC 4180, one header line.

#include <string>
#include <vector>

class Csv
{
  public:
    explicit Csv(const std::vector<std::string>& columns);

    void row(const std::vector<std::string>& cells); // as many as there are columns
    const std::string& text() const { return text_; }

  private:
    void line(const std::vector<std::string>& cells);

    size_t columnCount_;
    std::string text_;
};

// Reads back exactly; "nan" and "inf" where there is no number.
std::string csvNumber(double value);
