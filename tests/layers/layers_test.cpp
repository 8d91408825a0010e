// Which folder may include what: arrows point down only. The table below is the rule; this test
// reads every include line of the product against it, and every namespace against its folder.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Layer {
  std::string folder;                  ///< the rule of the longest matching folder counts
  std::vector<std::string> own;        ///< project folders it may include, besides itself
  std::vector<std::string> libraries;  ///< third-party headers it may include
};

// The standard library and POSIX are open to all, save for the real-time parts named in kGuarded.
const std::vector<Layer> kLayers{
    {"config/schema", {"config/units"}, {"toml++"}},
    {"config/signals", {}, {}},
    {"config/units", {}, {}},
    {"config/messages", {"config/schema"}, {"lcm", "spoolwatch"}},
    {"config/record", {"config/schema", "config/units", "config/messages"}, {"spoolwatch"}},
    {"config/record/hdf5", {"config/schema", "config/record"}, {"hdf5"}},
    {"plant_sim", {"config/schema", "config/signals", "config/units"}, {"muParser"}},
    {"estimator", {"config/schema", "config/signals"}, {"Eigen"}},
    {"estimator/linear_algebra", {}, {"Eigen"}},
    {"estimator/residual", {"config/signals", "estimator/linear_algebra"}, {"Eigen", "boost"}},
    {"estimator/spectra", {"config/signals", "estimator/linear_algebra"}, {"Eigen", "unsupported"}},
    {"estimator/nonlinear",
     {"config/signals", "estimator/linear_algebra", "estimator/residual"},
     {"Eigen"}},
    {"estimator/structures",
     {"config/schema", "config/signals", "estimator", "estimator/linear_algebra",
      "estimator/nonlinear", "estimator/residual"},
     {"Eigen"}},
    {"estimator/greybox",
     {"config/schema", "config/signals", "config/units", "config/record", "plant_sim", "estimator",
      "estimator/linear_algebra", "estimator/nonlinear", "estimator/residual"},
     {"Eigen"}},
    {"estimator/greybox/disturbance",
     {"plant_sim", "estimator", "estimator/linear_algebra", "estimator/nonlinear",
      "estimator/greybox"},
     {"Eigen", "unsupported"}},
    {"estimator/greybox/selection",
     {"config/schema", "config/units", "config/record", "plant_sim", "estimator",
      "estimator/linear_algebra", "estimator/residual", "estimator/greybox",
      "estimator/greybox/disturbance"},
     {"Eigen"}},
    {"estimator/greybox/tracking",
     {"config/schema", "config/signals", "config/units", "plant_sim", "estimator",
      "estimator/linear_algebra", "estimator/nonlinear", "estimator/greybox",
      "estimator/greybox/disturbance"},
     {"Eigen"}},
    {"estimator/greybox/validation",
     {"config/schema", "config/signals", "config/units", "plant_sim", "estimator/linear_algebra",
      "estimator/residual", "estimator/spectra", "estimator/greybox"},
     {"Eigen"}},
    {"estimator/fdi",
     {"config/schema", "config/signals", "estimator", "estimator/linear_algebra",
      "estimator/residual", "estimator/structures"},
     {"Eigen"}},
    {"estimator/fdi/tracker",
     {"config/schema", "config/signals", "config/units", "estimator", "estimator/fdi",
      "estimator/greybox", "estimator/greybox/tracking", "plant_sim"},
     {"Eigen"}},
    {"hal",
     {"config/schema", "config/signals", "hal/sim", "hal/replay", "hal/modbus", "hal/encoder",
      "hal/comedi"},
     {}},
    {"hal/sim", {"config/schema", "config/signals", "hal", "plant_sim"}, {}},
    {"hal/replay", {"config/schema", "config/signals", "config/record", "hal"}, {}},
    {"hal/modbus", {"config/schema", "config/signals", "hal"}, {"modbus"}},
    {"hal/encoder", {"config/schema", "config/signals", "hal"}, {"gpiod"}},
    {"hal/comedi", {"config/schema", "config/signals", "hal"}, {"comedilib"}},
    {"hal/hil_rig", {"config/schema", "hal", "plant_sim"}, {"modbus", "gpiod", "CLI"}},
    {"daemon/control", {"config/schema", "config/signals"}, {}},
    {"daemon/rt", {"config/schema", "config/signals", "hal", "daemon/control"}, {"boost"}},
    {"daemon/detection",
     {"config/schema", "config/signals", "estimator/fdi", "daemon/control", "daemon/rt",
      "daemon/io"},
     {"boost", "spoolwatch"}},
    {"daemon/io",
     {"config", "estimator", "estimator/fdi", "hal", "hal/sim", "hal/replay", "plant_sim",
      "daemon/control"},
     {"boost", "lcm", "spoolwatch", "systemd", "nlohmann"}},
    {"daemon",
     {"config", "estimator", "estimator/fdi", "estimator/fdi/tracker", "hal", "hal/sim",
      "hal/replay", "plant_sim", "daemon/control", "daemon/rt", "daemon/detection", "daemon/io"},
     {"boost", "lcm", "spoolwatch", "systemd", "CLI"}},
    {"workbench/add", {"config/schema", "plant_sim"}, {"nlohmann"}},
    {"workbench/files", {"config/schema", "config/record"}, {}},
    {"workbench/present",
     {"config/schema", "config/record", "config/signals", "config/units", "plant_sim",
      "estimator/greybox", "estimator/greybox/selection", "estimator/greybox/validation",
      "estimator/spectra"},
     {"nlohmann", "Eigen"}},
    {"workbench/exchange", {"config", "workbench/live"}, {"nlohmann", "spoolwatch", "matio"}},
    {"workbench/simulate", {"config", "daemon/control", "plant_sim"}, {}},
    {"workbench/estimate", {"config", "estimator"}, {"Eigen"}},
    {"workbench/select",
     {"config", "estimator", "estimator/residual", "estimator/structures", "workbench/present"},
     {"Eigen", "nlohmann"}},
    {"workbench/train", {"config", "estimator", "estimator/fdi"}, {"Eigen"}},
    {"workbench/compare",
     {"config", "plant_sim", "estimator/greybox", "estimator/greybox/selection",
      "estimator/greybox/validation", "workbench/fit", "workbench/present"},
     {"nlohmann", "Eigen"}},
    {"workbench/laws",
     {"config/units", "plant_sim", "estimator/greybox/validation", "workbench/present"},
     {}},
    {"workbench/fit",
     {"config", "plant_sim", "estimator", "estimator/nonlinear", "estimator/greybox",
      "estimator/greybox/selection", "workbench/files", "workbench/present"},
     {"nlohmann", "Eigen"}},
    {"workbench/model",
     {"config", "plant_sim", "estimator/greybox", "workbench/present", "workbench/questions"},
     {"nlohmann"}},
    {"workbench/questions", {"config/schema", "config/units"}, {}},
    {"workbench/stand", {"config/schema", "config/record", "workbench/questions"}, {}},
    {"workbench/diagnose",
     {"config", "daemon/control", "plant_sim", "estimator", "estimator/residual",
      "estimator/greybox", "estimator/greybox/selection", "estimator/greybox/validation",
      "estimator/spectra", "workbench/files", "workbench/fit", "workbench/present",
      "workbench/simulate"},
     {"nlohmann", "Eigen"}},
    {"workbench/isolate",
     {"config", "plant_sim", "estimator/fdi", "estimator/fdi/tracker", "estimator/residual",
      "estimator/greybox", "estimator/greybox/tracking", "workbench/files", "workbench/fit",
      "workbench/present"},
     {"nlohmann", "Eigen"}},
    {"workbench/reproduce",
     {"config", "plant_sim", "estimator", "estimator/fdi", "workbench/simulate"},
     {"nlohmann", "Eigen"}},
    {"workbench/scorecard",
     {"config", "plant_sim", "estimator", "estimator/fdi", "estimator/fdi/tracker",
      "estimator/residual", "workbench/present", "workbench/simulate", "workbench/train"},
     {"nlohmann", "Eigen"}},
    {"workbench/control", {"config", "daemon/control"}, {"nlohmann"}},
    {"workbench/live",
     {"config", "plant_sim", "estimator/residual", "estimator/greybox",
      "estimator/greybox/validation", "workbench/compare", "workbench/present"},
     {"nlohmann", "lcm", "spoolwatch", "ncurses"}},
    {"workbench/replay",
     {"config", "estimator", "estimator/fdi", "estimator/fdi/tracker", "workbench/train"},
     {"nlohmann", "spoolwatch"}},
    {"workbench/promotion",
     {"config", "daemon/control", "plant_sim", "estimator/fdi", "estimator/fdi/tracker",
      "estimator/greybox", "estimator/greybox/validation", "workbench/control", "workbench/replay"},
     {"nlohmann"}},
    {"workbench/serve",
     {"config", "daemon/control", "plant_sim", "estimator/greybox", "estimator/greybox/selection",
      "estimator/greybox/validation", "workbench/add", "workbench/compare", "workbench/control",
      "workbench/diagnose", "workbench/files", "workbench/fit", "workbench/laws", "workbench/live",
      "workbench/model", "workbench/present", "workbench/questions"},
     {"boost", "Eigen", "nlohmann", "spoolwatch"}},
    {"workbench/cli",
     {"config", "daemon/control", "plant_sim", "estimator", "estimator/fdi",
      "estimator/fdi/tracker", "estimator/greybox", "estimator/greybox/selection",
      "estimator/greybox/tracking", "estimator/greybox/validation", "workbench"},
     {"CLI", "nlohmann", "lcm", "spoolwatch", "Eigen"}},
};

// Headers of third parties: whoever includes one must have it in its row.
const std::vector<std::string> kGuarded{"toml++", "Eigen",   "ceres",     "lcm",      "spoolwatch",
                                        "boost",  "systemd", "CLI",       "nlohmann", "ncurses",
                                        "modbus", "gpiod",   "comedilib", "muParser", "matio"};
const std::vector<std::string> kProject{"config", "plant_sim", "estimator",
                                        "hal",    "daemon",    "workbench"};

bool below(const std::string& path, const std::string& folder) {
  return path.rfind(folder, 0) == 0 &&
         (path.size() == folder.size() || path[folder.size()] == '/' || path[folder.size()] == '.');
}

const Layer* layer_of(const std::string& file) {
  const Layer* found = nullptr;
  for (const Layer& layer : kLayers) {
    if (below(file, layer.folder) && (!found || layer.folder.size() > found->folder.size())) {
      found = &layer;
    }
  }
  return found;
}

bool allowed(const Layer& layer, const std::string& file, const std::string& header) {
  const auto matches = [&](const std::string& folder) { return below(header, folder); };
  if (std::any_of(kProject.begin(), kProject.end(), matches)) {
    if (fs::path(header).parent_path() == fs::path(file).parent_path()) return true;
    const Layer* target = layer_of(header);
    if (target == &layer) return true;
    // A name with a row of its own opens that row's files; one without ("config") all below it.
    return std::any_of(layer.own.begin(), layer.own.end(), [&](const std::string& own) {
      const bool has_row = std::any_of(kLayers.begin(), kLayers.end(),
                                       [&](const Layer& row) { return row.folder == own; });
      return has_row ? target != nullptr && target->folder == own : below(header, own);
    });
  }
  if (std::any_of(kGuarded.begin(), kGuarded.end(), matches)) {
    return std::any_of(layer.libraries.begin(), layer.libraries.end(), matches);
  }
  return true;
}

/// Every .h and .cpp of the product, relative to `root`.
std::vector<std::string> sources(const fs::path& root) {
  std::vector<std::string> files;
  for (const std::string& top : kProject) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string ending = entry.path().extension().string();
      if (ending == ".h" || ending == ".cpp") {
        files.push_back(fs::relative(entry.path(), root).string());
      }
    }
  }
  return files;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// "file:line includes header" for every include that the table does not allow.
std::vector<std::string> violations(const fs::path& root) {
  static const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<std::string> found;
  for (const std::string& file : sources(root)) {
    const Layer* layer = layer_of(file);
    if (layer == nullptr) {
      found.push_back(file + " stands in no layer");
      continue;
    }
    int number = 0;
    for (const std::string& line : lines_of(root / file)) {
      ++number;
      std::smatch match;
      if (std::regex_search(line, match, include) && !allowed(*layer, file, match[1])) {
        found.push_back(file + ":" + std::to_string(number) + " includes " + match[1].str());
      }
    }
  }
  return found;
}

/// The namespace of a folder: its path, where `daemon` is `monitor` (libc declares daemon()).
std::string namespace_of(const std::string& folder) {
  std::string name = below(folder, "daemon") ? "monitor" + folder.substr(6) : folder;
  for (std::size_t at = 0; (at = name.find('/', at)) != std::string::npos;)
    name.replace(at, 1, "::");
  return name;
}

/// "file:line opens namespace" for every namespace that is not the folder's, nor one of the file's
/// own inside it. Others may be opened to declare types, no more.
std::vector<std::string> foreign_namespaces(const fs::path& root) {
  static const std::regex opening(R"(^(?:inline )?namespace ([\w:]+) \{)");
  static const std::regex declaration(R"(^(struct|class|enum class) [\w: ]+;$)");
  static const std::regex main_program(R"(^int main\()");
  const std::vector<std::string> files = sources(root);
  std::set<std::string> folders;
  for (const std::string& file : files) {
    folders.insert(namespace_of(fs::path(file).parent_path().string()));
  }
  std::vector<std::string> found;
  for (const std::string& file : files) {
    const std::string own = namespace_of(fs::path(file).parent_path().string());
    const std::vector<std::string> lines = lines_of(root / file);
    bool inside = false;  // the file opens its folder's namespace
    bool is_main = false;
    std::string last;  // closing line of the namespace that is open
    for (std::size_t i = 0; i < lines.size(); ++i) {
      is_main = is_main || std::regex_search(lines[i], main_program);
      std::smatch match;
      if (!last.empty()) {
        if (lines[i] == last) last.clear();
        continue;
      }
      if (lines[i] == "namespace {") last = "}  // namespace";
      if (!std::regex_search(lines[i], match, opening)) continue;
      const std::string name = match[1];
      if (name == own || (name.rfind(own + "::", 0) == 0 && folders.count(name) == 0)) {
        inside = true;
        last = "}  // namespace " + name;
        continue;
      }
      const auto first = lines.begin() + static_cast<std::ptrdiff_t>(i) + 1;
      const auto end = std::find_if(
          first, lines.end(), [](const std::string& line) { return line.rfind("}", 0) == 0; });
      const bool declares = std::all_of(first, end, [](const std::string& line) {
        return line.empty() || std::regex_search(line, declaration);
      });
      if (!declares) {
        found.push_back(file + ":" + std::to_string(i + 1) + " opens " + name);
      }
    }
    if (!inside && !is_main) found.push_back(file + " opens no " + own);
  }
  return found;
}

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

TEST(Layers, NoFileOfTheProductIncludesUpwards) {
  EXPECT_THAT(violations(SPOOLWATCH_SOURCE_DIR), testing::IsEmpty());
}

TEST(Layers, EveryRowNamesAFolderThatExists) {
  for (const Layer& layer : kLayers) {
    EXPECT_TRUE(fs::is_directory(fs::path(SPOOLWATCH_SOURCE_DIR) / layer.folder)) << layer.folder;
  }
}

TEST(Layers, EveryNamespaceIsThatOfItsFolder) {
  EXPECT_THAT(foreign_namespaces(SPOOLWATCH_SOURCE_DIR), testing::IsEmpty());
}

TEST(Layers, PlantedViolationsAreFound) {
  const fs::path root = fs::path(testing::TempDir()) / "layers_planted";
  fs::remove_all(root);
  write(root / "plant_sim/plant.cpp", "#include <cmath>\n#include \"estimator/batch.h\"\n");
  write(root / "estimator/batch.h", "#include <Eigen/Dense>\n#include <lcm/lcm-cpp.hpp>\n");
  write(root / "estimator/fdi/pipeline.h", "#include \"estimator/batch.h\"\n");
  write(root / "daemon/control/arming.h", "  #  include \"daemon/rt/loop.h\"\n");
  write(root / "daemon/rt/loop.h", "#include \"daemon/io/publisher.h\"\n");
  write(root / "hal/sim/rig.h", "#include \"plant_sim/plant.h\"\n#include \"hal/replay/x.h\"\n");
  write(root / "hal/replay/x.h", "#include \"plant_sim/plant.h\"\n");
  write(root / "workbench/fit/page.cpp", "#include \"daemon/io/recorder.h\"\n");
  write(root / "workbench/fit/request.cpp", "#include \"workbench/cli/interrupt.h\"\n");
  write(root / "workbench/present/report.h", "#include \"workbench/fit/fit_report.h\"\n");
  write(root / "estimator/greybox/fit.h", "#include \"estimator/greybox/selection/problem.h\"\n");
  EXPECT_THAT(
      violations(root),
      testing::UnorderedElementsAre(
          "plant_sim/plant.cpp:2 includes estimator/batch.h",
          "estimator/batch.h:2 includes lcm/lcm-cpp.hpp",
          "daemon/control/arming.h:1 includes daemon/rt/loop.h",
          "daemon/rt/loop.h:1 includes daemon/io/publisher.h",
          "hal/sim/rig.h:2 includes hal/replay/x.h", "hal/replay/x.h:1 includes plant_sim/plant.h",
          "workbench/fit/page.cpp:1 includes daemon/io/recorder.h",
          "workbench/fit/request.cpp:1 includes workbench/cli/interrupt.h",
          "workbench/present/report.h:1 includes workbench/fit/fit_report.h",
          "estimator/greybox/fit.h:1 includes estimator/greybox/selection/problem.h"));
  fs::remove_all(root);
}

TEST(Layers, PlantedForeignNamespacesAreFound) {
  const fs::path root = fs::path(testing::TempDir()) / "namespaces_planted";
  fs::remove_all(root);
  write(root / "plant_sim/effects/friction.h",
        "namespace plant_sim {\nint n;\n}  // namespace plant_sim\n");
  write(root / "plant_sim/plant.h", "namespace plant_sim::effects {\nint n;\n}\n");
  write(root / "plant_sim/limits.h",
        "namespace CLI {\nclass App;\n}\nnamespace plant_sim::limits {\nint n;\n"
        "}  // namespace plant_sim::limits\n");
  write(root / "plant_sim/global.h", "int n;\n");
  write(root / "daemon/control/arming.h", "namespace daemon::control {\nint n;\n}\n");
  write(root / "daemon/rt/loop.h",
        "namespace monitor::rt {\nint n;\n}  // namespace monitor::rt\n");
  write(root / "daemon/main.cpp", "int main() { return 0; }\n");
  EXPECT_THAT(foreign_namespaces(root),
              testing::UnorderedElementsAre(
                  "plant_sim/effects/friction.h:1 opens plant_sim",
                  "plant_sim/effects/friction.h opens no plant_sim::effects",
                  "plant_sim/plant.h:1 opens plant_sim::effects",
                  "plant_sim/plant.h opens no plant_sim", "plant_sim/global.h opens no plant_sim",
                  "daemon/control/arming.h:1 opens daemon::control",
                  "daemon/control/arming.h opens no monitor::control"));
  fs::remove_all(root);
}

}  // namespace
