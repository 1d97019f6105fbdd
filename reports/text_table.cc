#include "reports/text_table.h"

#include <algorithm>

namespace softland::internal {

std::size_t display_width(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string left_aligned(const std::string& text, std::size_t columns) {
  return text + std::string(columns - std::min(columns, display_width(text)), ' ');
}

std::string right_aligned(const std::string& text, std::size_t columns) {
  return std::string(columns - std::min(columns, display_width(text)), ' ') + text;
}

std::string text_table(std::vector<TextColumn> columns, const std::vector<TextRow>& rows) {
  std::vector<std::string> heads;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    TextColumn& column = columns[i];
    heads.push_back(column.head);
    if (!column.grows) continue;
    column.width = std::max(column.width, display_width(column.head));
    for (const auto& row : rows) column.width = std::max(column.width, i < row.size() ? display_width(row[i]) : 0);
  }
  std::string text;
  const auto add = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const TextColumn& column = columns[i];
      line += std::string(column.gap, ' ') +
              (column.is_words ? left_aligned(cells[i], column.width) : right_aligned(cells[i], column.width));
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  };
  add(heads);
  for (const auto& row : rows) add(row);
  return text;
}

std::vector<TextColumn> number_columns(const std::vector<std::string>& heads, std::size_t width) {
  std::vector<TextColumn> columns;
  for (const std::string& head : heads) columns.push_back({.head = head, .width = width});
  return columns;
}

}  // namespace softland::internal
