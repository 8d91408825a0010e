#include "workbench/scorecard/method.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "workbench/learn_bands.h"
#include "workbench/scorecard/shipped.h"
#include "workbench/simulate/closed_loop.h"

namespace workbench::scorecard {
namespace {

namespace fdi = estimator::fdi;
using config::schema::Document;

Document open(const std::string& file) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored)) return Document::load(file);
  std::string known;
  for (const std::string& name : shipped_methods()) {
    const std::string stem = std::filesystem::path(name).stem().string();
    if (file == name || file == stem) return Document::parse(*shipped_text(name), name);
    known += (known.empty() ? "" : ", ") + stem;
  }
  throw config::schema::bad_config(file, "is no file and no method that is shipped", known);
}

bool open_ended(const fdi::BandConfig& band) {
  return std::isinf(band.low) && std::isinf(band.high);
}

}  // namespace

void Method::visit(config::schema::Visitor& v) {
  v.text({"name", "as it is shown", true}, name);
  v.text({"what", "in a few words"}, what);
  v.number({"false_alarm_time_s", "between false alarms, of each learned band"}, false_alarm_time_s,
           {1.0, 1e9});
  pipeline.visit(v);
}

Method load_method(const std::string& file) {
  const Document document = open(file);
  Method method;
  method.file = file;
  document.read([&](config::schema::Visitor& v) { method.visit(v); });
  method.pipeline.load_bands(document.folder(), simulate::kSampleTime_s);
  method.text = config::schema::print_toml([&](config::schema::Visitor& v) { method.visit(v); });
  fdi::PipelineConfig limited = method.pipeline;
  for (fdi::BandConfig& band : limited.bands) {
    if (open_ended(band)) band.high = 0.0;
  }
  try {  // before hours are simulated for nothing
    const fdi::Pipeline checked(limited, simulate::kSampleTime_s);
  } catch (const config::schema::Error& error) {
    throw config::schema::Error(static_cast<config::schema::ExitCode>(error.exit_code()),
                                file + ": " + error.what());
  }
  return method;
}

fdi::PipelineConfig train(const Method& method, const Samples& healthy, const std::string& record) {
  fdi::PipelineConfig trained = method.pipeline;
  const auto open = [](const fdi::BandConfig& band) { return open_ended(band); };
  if (std::none_of(trained.bands.begin(), trained.bands.end(), open)) return trained;
  const config::record::Record learnt = to_record(healthy, record);
  LearnOptions options;
  options.config = method.file;
  options.false_alarm_time_s = method.false_alarm_time_s;
  const fdi::LearnedBands bands = learn_bands(
      method.pipeline, wanted_quantities(method.pipeline, method.file), {&learnt, 1}, options);
  for (const fdi::LearnedBand& learned : bands.bands) {
    for (fdi::BandConfig& band : trained.bands) {
      if (band.quantity != learned.quantity || !open_ended(band)) continue;
      band.low = learned.low;
      band.high = learned.high;
      if (band.hysteresis == 0.0) band.hysteresis = learned.hysteresis;
    }
  }
  return trained;
}

}  // namespace workbench::scorecard
