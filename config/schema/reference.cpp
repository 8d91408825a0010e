#include "config/schema/reference.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "config/schema/joined.h"
#include "config/units/quantity.h"

namespace config::schema {
namespace {

std::string rounded(double value) {
  constexpr int kDigits = 12;
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.*g", kDigits, value);
  return buffer;
}

/// "0 to 10", "0 and more", "" for any number.
template <class T>
std::string allowed_in(T min, T max, T lowest, T highest) {
  const auto text = [](T value) {
    if constexpr (std::is_integral_v<T>) {
      return std::to_string(value);
    } else {
      return rounded(value);
    }
  };
  if (min == lowest && max == highest) return "";
  if (max == highest) return text(min) + " and more";
  if (min == lowest) return text(max) + " and less";
  return text(min) + " to " + text(max);
}

std::string allowed_in(Range range) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return allowed_in(range.min, range.max, -kInfinity, kInfinity);
}

std::string code(const std::string& text) { return "`" + text + "`"; }

std::string codes(const std::vector<std::string>& texts) { return joined_by(texts, code); }

std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) {
    text.insert(at, "\\");
  }
  return text;
}

struct ListedKey {
  std::string table;  ///< dotted path
  std::string key;    ///< empty: the table itself
  std::string type;
  std::string allowed;
  std::string otherwise;  ///< its default
  std::string what;

  auto operator<=>(const ListedKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

struct ListedTable {
  std::string path;
  std::string heading;
  std::string what;
};

struct Choice {
  std::vector<std::string> values;
  std::string taken;
};

using Assignments = std::map<std::string, std::string>;  ///< chosen values, by dotted path

/// Tables and rows listed by one visit, with some choices made otherwise than by default.
struct Listing {
  std::vector<ListedTable> tables;
  std::vector<ListedKey> rows;
  std::vector<std::pair<std::string, Choice>> choices;
};

class ListingVisitor final : public Visitor {
 public:
  ListingVisitor(Listing& listing, const Assignments& assignments,
                 const std::vector<Alternatives>& texts, std::string path)
      : listing_(listing), assignments_(assignments), texts_(texts), path_(std::move(path)) {}

  void boolean(Key key, bool& value) override { add(key, "boolean", "", value ? "true" : "false"); }
  void integer(Key key, std::int64_t& value, IntRange range) override {
    using Limits = std::numeric_limits<std::int64_t>;
    add(key, "integer", allowed_in(range.min, range.max, Limits::min(), Limits::max()),
        std::to_string(value));
  }
  void number(Key key, double& value, Range range) override {
    add(key, "number", allowed_in(range), std::isnan(value) ? "" : rounded(value));
  }
  void text(Key key, std::string& value) override {
    const std::string before = value;
    std::string list;
    for (const Alternatives& text : texts_) {
      if (text.key != key.name && text.key != below(key)) continue;
      list = codes(text.values);
      choose(key, value, text.values);
      break;
    }
    add(key, "text", list, before.empty() ? "" : '"' + before + '"');
  }
  void choice(Key key, std::string& value, const std::vector<std::string_view>& allowed) override {
    const std::string before = value;
    choose(key, value, {allowed.begin(), allowed.end()});
    add(key, "text", codes({allowed.begin(), allowed.end()}),
        before.empty() ? "" : '"' + before + '"');
  }
  void numbers(Key key, std::vector<double>& value, Range range) override {
    const std::string list = joined_by(value, rounded);
    add(key, "numbers", allowed_in(range), list.empty() ? "" : '[' + list + ']');
  }
  void texts(Key key, std::vector<std::string>& value) override {
    std::string list;
    for (const std::string& one : value) list += (list.empty() ? "\"" : ", \"") + one + '"';
    add(key, "texts", "", list.empty() ? "" : '[' + list + ']');
  }
  void table(Key key, const Body& body) override { nested(key, "[", "]", body); }
  void optional_table(Key key, bool& present, const Body& body) override {
    present = true;
    nested(key, "[", "]", body);
  }
  std::vector<std::string> names(Key, const std::vector<std::string>&) override { return {"NAME"}; }
  std::size_t list(Key, std::size_t) override { return 1; }
  void element(Key key, std::size_t, const Body& body) override { nested(key, "[[", "]]", body); }

 private:
  [[nodiscard]] std::string below(Key key) const {
    return path_.empty() ? std::string(key.name) : path_ + '.' + std::string(key.name);
  }
  void choose(Key key, std::string& value, const std::vector<std::string>& values) {
    const auto given = assignments_.find(below(key));
    if (given != assignments_.end()) value = given->second;
    listing_.choices.push_back({below(key), {values, value}});
  }
  void add(Key key, const std::string& type, const std::string& allowed,
           const std::string& otherwise) {
    const std::string unit = units::unit_of(key.name);
    listing_.rows.push_back({path_, std::string(key.name), type + (unit.empty() ? "" : ", " + unit),
                             allowed, key.required ? "must be given" : otherwise,
                             std::string(key.what)});
  }
  void nested(Key key, const std::string& open, const std::string& close, const Body& body) {
    listing_.rows.push_back({below(key), "", "", "", "", ""});
    listing_.tables.push_back({below(key), open + below(key) + close, std::string(key.what)});
    ListingVisitor inner(listing_, assignments_, texts_, below(key));
    body(inner);
  }

  Listing& listing_;
  const Assignments& assignments_;
  const std::vector<Alternatives>& texts_;
  std::string path_;
};

class ConfigurationReference {
 public:
  ConfigurationReference(const Visitor::Body& visit_default, const std::vector<Alternatives>& texts)
      : visit_default_(visit_default), texts_(texts) {
    Assignments none;
    explore(none);
  }

  [[nodiscard]] std::string markdown(const std::string& hashes) const {
    std::string text;
    for (const ListedTable& table : tables_) {
      std::vector<const ListedKey*> rows;
      const ListedKey* itself = nullptr;
      for (const ListedKey& row : rows_) {
        if (row.table != table.path) continue;
        if (row.key.empty()) {
          itself = &row;
        } else {
          rows.push_back(&row);
        }
      }
      if (rows.empty()) continue;
      text += '\n' + hashes + ' ' + (table.path.empty() ? "Top of the file" : code(table.heading));
      text += "\n\n";
      std::string intro = table.what;
      const std::string shared = itself == nullptr ? "" : condition(*itself, nullptr);
      if (!shared.empty()) intro += (intro.empty() ? "" : "; ") + ("with " + shared);
      if (!intro.empty()) {
        intro.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(intro.front())));
        text += intro + ".\n\n";
      }
      text += "| key | type, unit | allowed | default | meaning |\n|---|---|---|---|---|\n";
      for (const ListedKey* row : rows) {
        const std::string when = condition(*row, itself);
        const std::string meaning =
            row->what + (when.empty() ? "" : (row->what.empty() ? "" : "; ") + ("with " + when));
        text += "| " + code(row->key) + " | " + row->type + " | " + cell(row->allowed) + " | " +
                cell(row->otherwise) + " | " + cell(meaning) + " |\n";
      }
    }
    return text;
  }

 private:
  [[nodiscard]] Listing list(const Assignments& assignments) const {
    Listing listing;
    listing.tables.push_back({"", "", ""});
    ListingVisitor collector(listing, assignments, texts_, "");
    visit_default_(collector);
    return listing;
  }

  /// Inserts what is new behind what stands before it in `listing`, and behind alternatives to it.
  void merge(const Listing& listing) {
    const std::set<ListedKey> listed(listing.rows.begin(), listing.rows.end());
    std::size_t at = 0;
    for (const ListedKey& row : listing.rows) {
      const auto known = std::find(rows_.begin(), rows_.end(), row);
      if (known != rows_.end()) {
        at = static_cast<std::size_t>(known - rows_.begin()) + 1;
        continue;
      }
      while (at < rows_.size() && rows_[at].table == row.table && listed.count(rows_[at]) == 0)
        ++at;
      rows_.insert(rows_.begin() + static_cast<std::ptrdiff_t>(at++), row);
    }
    at = 0;
    for (const ListedTable& table : listing.tables) {
      const auto known = std::find_if(tables_.begin(), tables_.end(), [&](const ListedTable& old) {
        return old.path == table.path;
      });
      if (known != tables_.end()) {
        at = static_cast<std::size_t>(known - tables_.begin()) + 1;
      } else {
        tables_.insert(tables_.begin() + static_cast<std::ptrdiff_t>(at++), table);
      }
    }
  }

  void explore(const Assignments& assignments) {
    const Listing base = list(assignments);
    merge(base);
    for (const auto& [path, choice] : base.choices) {
      if (!explored_.insert(path).second) continue;
      std::map<ListedKey, std::vector<std::string>> present;
      for (const std::string& value : choice.values) {
        Assignments other = assignments;
        other[path] = value;
        const Listing listing = value == choice.taken ? base : list(other);
        merge(listing);
        for (const ListedKey& row : std::set<ListedKey>(listing.rows.begin(), listing.rows.end())) {
          present[row].push_back(value);
        }
      }
      for (const auto& [row, values] : present) {
        if (values.size() < choice.values.size()) {
          conditions_[row].push_back({path, values, choice.values});
        }
      }
      for (const std::string& value : choice.values) {
        Assignments other = assignments;
        other[path] = value;
        if (value != choice.taken) explore(other);
      }
    }
  }

  struct Condition {
    std::string path;
    std::vector<std::string> values;
    std::vector<std::string> all;
  };

  /// "`plant` = "velocity_servo"", "" for a key that is always read; what its table says of the
  /// same choice is left out.
  [[nodiscard]] std::string condition(const ListedKey& row, const ListedKey* table) const {
    const auto found = conditions_.find(row);
    if (found == conditions_.end()) return "";
    const auto shared = table == nullptr ? conditions_.end() : conditions_.find(*table);
    std::map<std::string, std::string> by_key;  // last part of the path -> whole condition
    std::vector<std::string> order;
    for (const Condition& one : found->second) {
      const auto same = [&](const Condition& other) {
        return other.path == one.path && other.values == one.values;
      };
      if (shared != conditions_.end() &&
          std::any_of(shared->second.begin(), shared->second.end(), same)) {
        continue;
      }
      const std::string key = one.path.substr(one.path.rfind('.') + 1);
      const bool again = by_key.count(key) > 0;
      const bool beside = one.path.substr(0, one.path.size() - key.size()) ==
                          (row.table.empty() ? "" : row.table + '.');
      std::string text = code(again || beside ? key : one.path) + ' ';
      if (one.values.size() + 1 == one.all.size() && one.all.size() > 2) {
        for (const std::string& value : one.all) {
          if (std::find(one.values.begin(), one.values.end(), value) == one.values.end()) {
            text += "other than \"" + value + '"';
          }
        }
      } else {
        text += "= ";
        for (std::size_t i = 0; i < one.values.size(); ++i) {
          text += (i == 0 ? "\"" : " or \"") + one.values[i] + '"';
        }
      }
      if (!again) order.push_back(key);
      by_key[key] = text;
    }
    return joined_by(order, [&](const std::string& key) { return by_key[key]; });
  }

  const Visitor::Body& visit_default_;
  const std::vector<Alternatives>& texts_;
  std::vector<ListedTable> tables_;
  std::vector<ListedKey> rows_;
  std::set<std::string> explored_;
  std::map<ListedKey, std::vector<Condition>> conditions_;
};

}  // namespace

std::string print_reference(const Visitor::Body& visit_default, int level,
                            const std::vector<Alternatives>& texts) {
  return ConfigurationReference(visit_default, texts)
      .markdown(std::string(static_cast<std::size_t>(level), '#'));
}

}  // namespace config::schema
