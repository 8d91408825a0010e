#include "workbench/serve/kept_models.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "config/record/whole_file.h"

namespace workbench::serve {

void KeptModels::keep(const SessionFolder& folder, const std::string& model) {
  if (model.empty()) return;
  std::ifstream in(folder.path_of(model), std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (in.good() && !text.empty()) texts_[model] = std::move(text);
}

void KeptModels::restore(const SessionFolder& folder) const {
  for (const auto& [model, text] : texts_) {
    const std::string path = folder.path_of(model);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) config::record::write_whole(path, text);
  }
}

}  // namespace workbench::serve
