// Columns of numbers with a header line, separated by commas, as instruments and spreadsheets write them. Blank lines, lines
// that begin with '#', blanks around cells, a byte order mark and carriage returns are ignored.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace softland {

/// Returns file name and line number of a row of a CSV file, "file:line", for messages about the row.
using CsvPlace = std::function<std::string()>;

/// Calls row(values, place) for every row with the numbers of `columns`. `file` is the name of the file in messages; `expected`
/// describes the header ("time_s and one column per drive"). Throws InvalidInput with file, line and rule when
/// header or rows are missing, or the header does not have each of the `columns` exactly once. Also throws InvalidInput for a
/// row of another length than the header, and for a cell of `columns` that is not a finite number.
void read_csv(std::string_view content, const std::string& file, const std::vector<std::string>& columns,
              std::string_view expected, const std::function<void(std::span<const double>, const CsvPlace&)>& row);

}  // namespace softland
