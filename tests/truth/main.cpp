// Records with a known answer, made without any of the product's code.
//
//   spoolwatch-truth --seed N --case SPEC -o FILE.csv      one record; SPEC as in case.h, such as
//                                     motion=multisine,friction.coulomb_N=150,friction.static_N=190
//   spoolwatch-truth --plan PLAN --count N --seed S --out DIR [--jobs 2]
//                                     case0001.csv ..., answers.json, and the model files that the
//                                     records of another plant are to be diagnosed with (plan.h)
//   spoolwatch-truth --list           plans, keys of a case, motions and left-out effects
//
// A record: 30 s at 200 Hz in closed loop (Kp 100 V/m), 12 bits over +-10 V, encoder 5 um, noise
// 2 um, as t_s,u_V,y_m, where SPEC or plan say nothing else. The same seed and SPEC give the same
// file; answers.json holds both for every record. scripts/confusion makes the sets, runs the
// diagnosis on them and scores it.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <string>

#include "tests/truth/case.h"
#include "tests/truth/plan.h"

namespace {

int usage() {
  std::fputs(
      "usage: spoolwatch-truth --seed N --case SPEC -o FILE.csv\n"
      "       spoolwatch-truth --plan PLAN --count N --seed S --out DIR [--jobs N]\n"
      "       spoolwatch-truth --list\n",
      stderr);
  return 2;
}

void list() {
  for (const std::string& plan : truth::plans()) std::printf("plan %s\n", plan.c_str());
  for (const truth::Kind kind : truth::kKinds) {
    std::printf("rig=%s\n", truth::to_string(kind).c_str());
    for (const truth::PlantField& field : truth::plant_fields(kind)) {
      std::printf("  plant.%s\n", field.name.c_str());
    }
  }
  for (const truth::Parameter& parameter : truth::parameters()) {
    std::printf("%s.%s\n", parameter.effect.c_str(), parameter.name.c_str());
  }
  for (const std::string& key : truth::case_keys()) std::printf("%s\n", key.c_str());
  for (const std::string& motion : truth::motions()) std::printf("motion=%s\n", motion.c_str());
  for (const auto* table :
       {&truth::left_out_table(), &truth::axis_left_out_table(), &truth::library_law_table()}) {
    for (const truth::LeftOutInfo& info : *table) {
      std::printf("left_out=%s  %s, typically %g\n", info.name.c_str(), info.equation.c_str(),
                  info.typical);
    }
  }
}

int run(std::map<std::string, std::string>& option) {
  const auto seed = static_cast<std::size_t>(std::strtoull(option["--seed"].c_str(), nullptr, 10));
  if (option.count("--case") != 0 && option.count("-o") != 0) {
    truth::write_csv(truth::simulate(truth::parse_case(option["--case"], seed)), option["-o"]);
    return 0;
  }
  if (option.count("--plan") == 0 || option.count("--count") == 0 || option.count("--out") == 0) {
    return usage();
  }
  std::filesystem::create_directories(option["--out"]);
  const auto count = std::strtoull(option["--count"].c_str(), nullptr, 10);
  const int jobs = option.count("--jobs") != 0 ? std::atoi(option["--jobs"].c_str()) : 2;
  truth::write_plan(option["--plan"], count, seed, option["--out"], jobs < 1 ? 1 : jobs);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::map<std::string, std::string> option{{"--seed", "1"}};
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--list") return list(), 0;
    const bool known = name == "--seed" || name == "--case" || name == "-o" || name == "--plan" ||
                       name == "--count" || name == "--out" || name == "--jobs";
    if (!known || i + 1 >= argc) return usage();
    option[name] = argv[++i];
  }
  try {
    return run(option);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "spoolwatch-truth: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "spoolwatch-truth: %s\n", error.what());
    return 1;
  }
}
