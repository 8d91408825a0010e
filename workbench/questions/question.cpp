#include "workbench/questions/question.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"
#include "config/units/quantity.h"

namespace workbench::questions {
namespace {

using config::schema::UsageError;

/// Throws UsageError for an answer that is not allowed.
void check(const std::string& place, const Question& q, const std::string& text) {
  if (q.is_number()) {
    check_range(place, q, number_answer(place, q, text));
  } else {
    check_text(place, q, text);
  }
}

}  // namespace

Question whole_question(std::string flag, std::string what, std::string where, double min,
                        double max, double usual) {
  Question q{std::move(flag), std::move(what), std::move(where), min, max, usual};
  q.form = Form::whole;
  return q;
}

Question choice_question(std::string flag, std::string what, std::string where,
                         std::vector<std::string> choices, std::string usual) {
  Question q{std::move(flag), std::move(what), std::move(where)};
  q.form = Form::choice;
  q.choices = std::move(choices);
  q.usual_text = std::move(usual);
  return q;
}

Question text_question(std::string flag, std::string what, std::string where, std::string usual) {
  Question q{std::move(flag), std::move(what), std::move(where)};
  q.form = Form::text;
  q.usual_text = std::move(usual);
  return q;
}

std::optional<double> number_in(const std::string& text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, failed] = std::from_chars(text.data(), end, value);
  return failed == std::errc() && rest == end ? std::optional<double>(value) : std::nullopt;
}

std::string allowed(const Question& q) {
  if (q.form == Form::choice) return config::schema::joined(q.choices);
  if (q.form == Form::text) return "a text without quotes, backslashes and control characters";
  return fmt::format("{:g} to {:g}", q.min, q.max);
}

std::string usual_answer(const Question& q) {
  if (!q.is_number()) return q.usual_text;
  if (std::isnan(q.usual)) return "";
  return q.form == Form::whole ? fmt::format("{}", q.usual) : config::units::three_digits(q.usual);
}

bool must_be_given(const Question& q) {
  return q.is_number() ? std::isnan(q.usual) : q.usual_text.empty() && !q.may_be_empty;
}

double number_answer(const std::string& place, const Question& q, const std::string& text) {
  const std::optional<double> value = number_in(text);
  const bool fits = value && (q.form != Form::whole || *value == std::round(*value));
  if (fits) return *value;
  throw UsageError(fmt::format(
      "{}: --{} is \"{}\", no {}number; allowed: {}{}", place, q.flag, text, value ? "whole " : "",
      allowed(q), text.find(',') == std::string::npos ? "" : ", with a point for decimals"));
}

void check_range(const std::string& place, const Question& q, double value) {
  if (value >= q.min && value <= q.max) return;
  throw UsageError(
      fmt::format("{}: --{} is {:g}, out of range; allowed: {}", place, q.flag, value, allowed(q)));
}

void check_text(const std::string& place, const Question& q, const std::string& text) {
  if (q.form == Form::choice) {
    if (std::find(q.choices.begin(), q.choices.end(), text) != q.choices.end()) return;
    const std::string near = config::schema::nearest(text, q.choices);
    throw UsageError(config::schema::error_line(
        place + ": --" + q.flag,
        "is \"" + text.substr(0, 40) + "\"" + (near.empty() ? "" : ", did you mean " + near + "?"),
        allowed(q)));
  }
  if (is_plain(text) && (q.may_be_empty || !text.empty())) return;
  throw UsageError(
      place + ": --" + q.flag +
      (text.empty() ? " is empty" : " has a quote, a backslash or a control character") +
      "; allowed: " + allowed(q));
}

bool is_plain(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return c >= ' ' && c != '"' && c != '\\'; });
}

std::string asked(const Question& q, std::istream& in, std::ostream& out) {
  std::string usual = usual_answer(q);
  for (;;) {
    out << q.what << "\n  " << q.where << "; " << allowed(q) << "\n  --" << q.flag
        << (usual.empty() ? "" : " [" + usual + "]") << ": " << std::flush;
    std::string line;
    if (!std::getline(in, line)) {
      throw UsageError("new: the input ended before --" + q.flag + " was answered");
    }
    if (line.empty() && !must_be_given(q)) return usual;
    try {
      check("new", q, line);
      return line;
    } catch (const UsageError&) {
      out << "  " << (line.empty() ? "nothing" : line) << " is no answer; allowed: " << allowed(q)
          << "\n";
    }
  }
}

}  // namespace workbench::questions
