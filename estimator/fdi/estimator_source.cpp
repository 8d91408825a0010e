#include "estimator/fdi/estimator_source.h"

namespace estimator::fdi {

Finding EstimatorSource::find(std::span<NamedValue> values) noexcept {
  const Estimate found = stage_.estimate();
  const int size = stage_.structure().size();
  for (int i = 0; i < size; ++i) {
    NamedValue& v = values[static_cast<std::size_t>(i)];
    v.value = i < found.size ? found.value[i] : std::numeric_limits<double>::quiet_NaN();
    v.std_error = i < found.size ? found.std_error[i] : std::numeric_limits<double>::quiet_NaN();
  }
  values[static_cast<std::size_t>(size)].value = found.residual_rms_m;
  values[static_cast<std::size_t>(size) + 1].value = found.condition;
  return {found.valid, stage_.warming_up(), to_string(found.reason), found.condition,
          found.samples};
}

}  // namespace estimator::fdi
