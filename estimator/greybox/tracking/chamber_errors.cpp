#include "estimator/greybox/tracking/chamber_errors.h"

namespace estimator::greybox::tracking {
namespace {

constexpr double kMost_Pa = 1e9;

}  // namespace

void ChamberErrors::visit(config::schema::Visitor& v) {
  const auto number = [&](const char* name, const char* what, double& value, double least) {
    v.number({name, what}, value, {least, kMost_Pa});
  };
  number("pressure_in_error_Pa", "of a healthy window's pressure in; 0: not used", in.rms_Pa, 0.0);
  number("pressure_out_error_Pa", "of its pressure out; 0: not used", out.rms_Pa, 0.0);
  number("pressure_in_weight_Pa", "its sigma in the fit", in.weight_Pa, 0.0);
  number("pressure_out_weight_Pa", "its sigma in the fit", out.weight_Pa, 0.0);
  number("pressure_in_offset_Pa", "of the reading from the healthy model", in.offset_Pa, -kMost_Pa);
  number("pressure_out_offset_Pa", "of the reading from the healthy model", out.offset_Pa,
         -kMost_Pa);
  number("pressure_offset_sd_Pa", "how far an offset may be off that", offset_sd_Pa, 0.0);
}

void ChamberErrors::serialize(estimator::StateArchive& archive) {
  for (double* value : {&in.rms_Pa, &in.offset_Pa, &in.weight_Pa, &out.rms_Pa, &out.offset_Pa,
                        &out.weight_Pa, &offset_sd_Pa}) {
    archive.value(*value);
  }
}

}  // namespace estimator::greybox::tracking
