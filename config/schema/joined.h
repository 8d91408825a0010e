// Names in a sentence.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace config::schema {

/// "a, b, c" of anything that prints.
template <class Range = std::vector<std::string>>
[[nodiscard]] std::string joined(const Range& items, std::string_view separator = ", ") {
  return fmt::format("{}", fmt::join(items, separator));
}

/// The same of text(item): a function or a pointer to a member.
template <class Range, class Text>
[[nodiscard]] std::string joined_by(const Range& items, Text&& text,
                                    std::string_view separator = ", ") {
  std::vector<std::string> texts;
  texts.reserve(std::size(items));
  for (const auto& item : items) texts.emplace_back(std::invoke(text, item));
  return joined(texts, separator);
}

/// "a, b and c".
[[nodiscard]] inline std::string listed(const std::vector<std::string>& names,
                                        std::string_view last = "and") {
  if (names.size() < 2) return joined(names);
  return fmt::format("{} {} {}", fmt::join(names.begin(), names.end() - 1, ", "), last,
                     names.back());
}

}  // namespace config::schema
