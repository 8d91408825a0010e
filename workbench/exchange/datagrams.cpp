#include "workbench/exchange/datagrams.h"

namespace workbench::exchange {
namespace {

constexpr std::size_t kLongestText = 100;

/// One half of the members of the first object below `tree` that has several; false when there is
/// none.
bool keep_half(Tree& tree, bool first) {
  if (!tree.is_object()) return false;
  if (tree.size() > 1) {
    Tree half = Tree::object();
    std::size_t i = 0;
    for (auto& [key, value] : tree.items()) {
      if ((i++ < tree.size() / 2) == first) half[key] = std::move(value);
    }
    tree = std::move(half);
    return true;
  }
  return !tree.empty() && keep_half(tree.begin().value(), first);
}

void cut_texts(Tree& tree) {
  for (auto& value : tree) {
    if (value.is_structured()) cut_texts(value);
    if (!value.is_string()) continue;
    auto& text = value.get_ref<std::string&>();
    if (text.size() <= kLongestText) continue;
    text.resize(kLongestText);
    while (!text.empty() && (text.back() & 0x80) != 0) text.pop_back();  // no half letters
    text += "...";
  }
}

void split(Message message, std::size_t most_bytes, std::vector<std::string>& out) {
  std::string text = text_of(with_timestamp(message));
  if (text.size() > most_bytes) {
    Message rest = message;
    if (keep_half(message.values, true) && keep_half(rest.values, false)) {
      split(std::move(message), most_bytes, out);
      split(std::move(rest), most_bytes, out);
      return;
    }
    cut_texts(message.values);
    text = text_of(with_timestamp(message));
    if (text.size() > most_bytes) return;  // names longer than a datagram: not from our daemon
  }
  out.push_back(std::move(text));
}

}  // namespace

std::vector<std::string> datagrams_of(const Message& message, std::size_t most_bytes) {
  std::vector<std::string> out;
  split(message, most_bytes, out);
  return out;
}

}  // namespace workbench::exchange
