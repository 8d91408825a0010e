// `spoolwatch train CONFIG.toml --healthy RECORD... [--class NAME=RECORD]... -o trained.toml`:
// what [[cusum]], [[glr]], [[distance]], [[classifier]] and [[trend]] need to know, from records.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>

#include "config/record/record.h"
#include "config/record/whole_file.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/hotelling_t2.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/train/learn.h"
#include "workbench/train/rig_table.h"

namespace workbench::cli {
namespace {

namespace fdi = estimator::fdi;
using config::record::Record;

struct TrainOptions {
  std::string config;
  std::vector<std::string> healthy;
  std::vector<std::string> classes;
  std::string out;
  config::record::ReadOptions reading;
};

Record read(const std::string& file, const TrainOptions& options) {
  Record record = config::record::read_record(file, options.reading);
  config::record::require_volts_and_metres(record);
  for (const std::string& note : record.notes) {
    std::cerr << "spoolwatch: " << record.name << ": " << note << '\n';
  }
  return record;
}

/// NAME=RECORD; a + or - at the end of the name is the direction in which it has changed.
train::Teaching teaching_of(const std::string& text, const TrainOptions& options) {
  const std::size_t equals = text.find('=');
  train::Teaching teaching;
  teaching.name = text.substr(0, equals);
  if (!teaching.name.empty() && (teaching.name.back() == '+' || teaching.name.back() == '-')) {
    teaching.direction = teaching.name.back() == '+' ? 1 : -1;
    teaching.name.pop_back();
  }
  if (equals == std::string::npos || teaching.name.empty() ||
      teaching.name == fdi::TrainedFile::kHealthy) {
    throw config::schema::UsageError("--class " + text +
                                     ": is no class; allowed: NAME=RECORD, NAME+=RECORD (risen), "
                                     "NAME-=RECORD (fallen)");
  }
  teaching.records.push_back(read(text.substr(equals + 1), options));
  return teaching;
}

std::string shown(const fdi::TrainedClass& each) {
  return each.name + (each.direction > 0 ? "+" : each.direction < 0 ? "-" : "");
}

void print(const fdi::TrainedMethod& source, const fdi::TrainedMethodConfig& config) {
  std::cout << config.where() << ": ";
  if (source.block_s > 0.0) {
    std::cout << "blocks of " << source.block_s << " s:";
  } else {
    std::cout << "values:";
  }
  for (const fdi::TrainedClass& each : source.classes) {
    std::cout << ' ' << shown(each) << ' ' << each.blocks;
  }
  std::cout << '\n';
  const fdi::TrainedClass& healthy = *source.healthy();
  if (source.classes.size() == 1) {
    for (std::size_t i = 0; i < source.quantities.size(); ++i) {
      std::cout << "  " << source.quantities[i] << ": mean " << healthy.mean[i] << ", "
                << healthy.long_run[i] << " over long runs\n";
    }
    return;
  }
  // Distance of each class's mean from the others, in units of the other's spread.
  for (const fdi::TrainedClass& each : source.classes) {
    double least = std::numeric_limits<double>::infinity();
    std::string nearest;
    for (const fdi::TrainedClass& other : source.classes) {
      if (&other == &each) continue;
      fdi::HotellingT2 region(other.mean, other.covariance, static_cast<double>(other.blocks),
                              config.where() + ": class " + other.name);
      const double distance = std::sqrt(region.statistic(each.mean));
      if (distance >= least) continue;
      least = distance;
      nearest = shown(other);
    }
    std::cout << "  " << shown(each) << " lies " << least << " deviations from " << nearest
              << (least < 3.0 ? ": they will be mistaken for each other" : "") << '\n';
  }
}

void run(const TrainOptions& options) {
  fdi::PipelineConfig pipeline;
  std::string rig_id = "rig";
  config::schema::Document::load(options.config).read_part([&](config::schema::Visitor& v) {
    pipeline.visit(v);
    train::visit_rig(v, rig_id);
  });
  std::vector<train::Teaching> teachings(1);
  teachings[0].name = fdi::TrainedFile::kHealthy;
  for (const std::string& file : options.healthy) {
    teachings[0].records.push_back(read(file, options));
  }
  for (const std::string& text : options.classes) {
    teachings.push_back(teaching_of(text, options));
  }
  fdi::TrainedFile trained = train::learn(pipeline, teachings, rig_id, options.config);
  for (const fdi::TrainedMethod& source : trained.methods) {
    print(source, dynamic_cast<const fdi::TrainedMethodConfig&>(*pipeline.find_method(source.id)));
  }
  config::record::write_whole(options.out,
                              config::schema::print_toml([&](auto& v) { trained.visit(v); }));
}

}  // namespace

void add_train(CLI::App& command, int& /*exit_code*/) {
  auto options = std::make_shared<TrainOptions>();
  command.add_option("config", options->config, "configuration with the methods to train")
      ->required();
  command
      .add_option("--healthy", options->healthy, "records of the healthy rig: CSV, MAT, LCM log")
      ->required();
  command.add_option("--class", options->classes,
                     "NAME=RECORD of a fault; NAME+= when it has risen, NAME-= when fallen");
  add_reading(command, options->reading);
  command.add_option("-o,--output", options->out, "output file (TOML)")->required();
  command.callback([options] { run(*options); });
}

}  // namespace workbench::cli
