#include "config/record/clock_text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "config/record/text_fields.h"

namespace config::record {
namespace {

/// Days since 1970-01-01 of the proleptic Gregorian calendar.
std::int64_t days_of(std::int64_t year, std::int64_t month, std::int64_t day) {
  year -= month <= 2 ? 1 : 0;
  const std::int64_t era = (year >= 0 ? year : year - 399) / 400;
  const std::int64_t year_of_era = year - era * 400;
  const std::int64_t day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const std::int64_t day_of_era =
      year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return era * 146097 + day_of_era - 719468;
}

bool take_integer(std::string_view& text, std::size_t least, std::size_t most,
                  std::int64_t& value) {
  std::size_t digits = 0;
  while (digits < text.size() && digits < most && is_digit(text[digits])) ++digits;
  if (digits < least) return false;
  value = 0;
  for (std::size_t i = 0; i < digits; ++i) value = 10 * value + (text[i] - '0');
  text.remove_prefix(digits);
  return true;
}

bool take_char(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

/// Decimals of a second behind ".", "," or ":"; 0: none.
double take_fraction(std::string_view& text) {
  const bool mark =
      text.size() > 1 && (text.front() == '.' || text.front() == ',' || text.front() == ':');
  if (!mark || !is_digit(text[1])) return 0.0;
  text.remove_prefix(1);
  double fraction = 0.0;
  double digit = 0.1;
  while (!text.empty() && is_digit(text.front())) {
    fraction += digit * (text.front() - '0');
    digit *= 0.1;
    text.remove_prefix(1);
  }
  return fraction;
}

/// "12:34:56.789", "12:34:56,789", "1:02:03 PM"; the rest stays in `text`. `elapsed`: a duration,
/// which may have any number of hours.
bool take_time_of_day(std::string_view& text, double& time_s, bool elapsed = false) {
  std::int64_t hours = 0;
  std::int64_t minutes = 0;
  std::int64_t seconds = 0;
  if (!take_integer(text, 1, elapsed ? 5 : 2, hours) || !take_char(text, ':') ||
      !take_integer(text, 2, 2, minutes) || !take_char(text, ':') ||
      !take_integer(text, 2, 2, seconds)) {
    return false;
  }
  const double fraction = take_fraction(text);
  if ((hours > 24 && !elapsed) || minutes > 59 || seconds > 60) return false;
  std::string_view rest = trimmed(text);
  const std::string half = lower(rest.substr(0, 2));
  if (half == "pm" || half == "am") {
    if (hours < 1 || hours > 12) return false;
    hours = hours % 12 + (half == "pm" ? 12 : 0);
    rest.remove_prefix(2);
    text = rest;
  }
  time_s = static_cast<double>(hours * 3600 + minutes * 60 + seconds) + fraction;
  return true;
}

/// "05:03.5", minutes and seconds as Excel shows them; without decimals they may be hours and
/// minutes.
bool take_minutes(std::string_view& text, double& time_s) {
  std::int64_t minutes = 0;
  std::int64_t seconds = 0;
  std::string_view rest = text;
  if (!take_integer(rest, 1, 4, minutes) || !take_char(rest, ':') ||
      !take_integer(rest, 2, 2, seconds) || seconds > 59) {
    return false;
  }
  if (rest.size() < 2 || rest.front() == ':' || !is_digit(rest[1])) return false;
  const double fraction = take_fraction(rest);
  if (!rest.empty()) return false;
  time_s = static_cast<double>(60 * minutes + seconds) + fraction;
  text = rest;
  return true;
}

/// The month that English or German begin so; 0: none.
std::int64_t month_of(std::string_view word) {
  constexpr std::array<std::string_view, 16> kMonths{"jan", "feb", "mar", "apr", "may", "jun",
                                                     "jul", "aug", "sep", "oct", "nov", "dec",
                                                     "mai", "okt", "dez", "mrz"};
  constexpr std::array<std::int64_t, 16> kNumbers{1, 2,  3,  4,  5, 6,  7,  8,
                                                  9, 10, 11, 12, 5, 10, 12, 3};
  const auto found = std::find(kMonths.begin(), kMonths.end(), lower(word));
  return found == kMonths.end() ? 0 : kNumbers[static_cast<std::size_t>(found - kMonths.begin())];
}

/// "01-May-2024", as MATLAB writes it; "01 May 2024".
bool take_date_in_words(std::string_view& text, std::int64_t& days) {
  constexpr std::size_t kLetters = 3;
  std::int64_t day = 0;
  std::int64_t year = 0;
  std::string_view rest = text;
  if (!take_integer(rest, 1, 2, day) || rest.size() <= kLetters + 1) return false;
  const char mark = rest.front();
  if (mark != '-' && mark != ' ') return false;
  rest.remove_prefix(1);
  const std::int64_t month = month_of(rest.substr(0, kLetters));
  rest.remove_prefix(kLetters);
  if (month == 0 || day < 1 || day > 31) return false;
  if (!take_char(rest, mark) || !take_integer(rest, 4, 4, year)) return false;
  days = days_of(year, month, day);
  text = rest;
  return true;
}

/// "0 days 00:00:00.005", as pandas writes a duration; the time of day stays in `text`.
bool take_days(std::string_view& text, std::int64_t& days) {
  std::string_view rest = text;
  if (!take_integer(rest, 1, 5, days)) return false;
  for (const std::string_view word : {" days ", " day "}) {
    if (!rest.starts_with(word)) continue;
    text = rest.substr(word.size());
    return true;
  }
  days = 0;
  return false;
}

/// "2024-05-01", "2024/05/01", "01.05.2024", "05/01/2024". Day and month of the last are the same
/// to a record, which counts from its first sample; over a change of date they are not.
bool take_date(std::string_view& text, std::int64_t& days) {
  std::int64_t a = 0;
  std::int64_t b = 0;
  std::int64_t c = 0;
  std::string_view rest = text;
  if (!take_integer(rest, 1, 4, a) || rest.empty()) return false;
  const char mark = rest.front();
  if (mark != '-' && mark != '/' && mark != '.') return false;
  rest.remove_prefix(1);
  if (!take_integer(rest, 1, 2, b) || !take_char(rest, mark) || !take_integer(rest, 1, 4, c)) {
    return false;
  }
  if (a > 31) {
    if (b < 1 || b > 12 || c < 1 || c > 31) return false;
    days = days_of(a, b, c);
  } else {
    if (c < 70) c += 2000;
    const bool month_first = mark == '/' && a <= 12;
    const std::int64_t month = month_first ? a : b;
    const std::int64_t day = month_first ? b : a;
    if (month < 1 || month > 12 || day < 1 || day > 31) return false;
    days = days_of(c, month, day);
  }
  text = rest;
  return true;
}

}  // namespace

bool parse_clock(std::string_view field, double& time_s) {
  if (field.size() < 6 || field.size() > 40 || !is_digit(field.front())) return false;
  std::string_view text = field;
  std::int64_t days = 0;
  double seconds = 0.0;
  if (take_days(text, days)) {
    if (!take_time_of_day(text, seconds)) return false;
  } else if (take_date(text, days) || take_date_in_words(text, days)) {
    if (!text.empty() && (text.front() == 'T' || text.front() == ' ')) text.remove_prefix(1);
    text = trimmed(text);
    if (text.empty() || !take_time_of_day(text, seconds)) return false;
  } else if (!take_minutes(text, seconds) && !take_time_of_day(text, seconds, true)) {
    return false;
  }
  text = trimmed(text);
  const bool zone = text.empty() || text == "Z" || text == "UTC" ||
                    ((text.front() == '+' || text.front() == '-') && text.size() <= 6);
  if (!zone) return false;
  time_s = static_cast<double>(days) * 86400.0 + seconds;
  return true;
}

}  // namespace config::record
