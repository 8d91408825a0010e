#include "estimator/fdi/detection_method.h"

#include <cmath>
#include <string_view>

namespace estimator::fdi {

void end_after_a_word(std::span<char> text, int wanted) noexcept {
  constexpr std::string_view kMore = "...";
  if (wanted < 0 || static_cast<std::size_t>(wanted) < text.size()) return;
  const std::size_t latest = text.size() - kMore.size() - 1;
  std::size_t end = latest;
  while (end > 0 && text[end] != ' ') --end;
  if (end == 0) end = latest;
  kMore.copy(&text[end], kMore.size());
  text[end + kMore.size()] = '\0';
}

void OutputPort::reset() noexcept {
  output = MethodOutput{};
  reason[0] = '\0';
  fresh = false;
  for (EstimatedValue& v : values) v.value = v.std_error = kNaN;
}

void OutputPort::serialize(StateArchive& archive) {
  for (EstimatedValue& v : values) {
    archive.value(v.value);
    archive.value(v.std_error);
  }
  archive.value(output.valid);
  archive.value(output.warming_up);
  archive.value(reason);
  reason[kReason - 1] = '\0';
  output.reason = reason;
}

bool MethodInput::usable() const noexcept {
  return port_->output.valid && !port_->output.warming_up && std::isfinite(value());
}

const char* MethodInput::why() const noexcept {
  if (port_->reason[0] != '\0') return port_->reason;
  return port_->output.warming_up ? "it is warming up" : "there is no such value yet";
}

}  // namespace estimator::fdi
