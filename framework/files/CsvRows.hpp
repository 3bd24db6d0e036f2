#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace kiln {

/// Calls `row` for each line of a comma-separated text with its number, from 1, and its cells. Quotes are those of RFC
/// 4180, without line breaks inside; blanks around cells, empty lines, lines that begin with '#' and the byte-order
/// mark that spreadsheets write first are left out. Throws FileError that names `file` and the line for one of more
/// than `longest` characters or with quotes amiss.
void for_each_csv_row(const std::string& file, std::string_view text, std::size_t longest,
                      const std::function<void(int line, const std::vector<std::string>& cells)>& row);

}  // namespace kiln
