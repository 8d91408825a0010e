#include "config/schema/product_version.h"

namespace config::schema {

std::string_view product_version() noexcept { return SPOOLWATCH_VERSION; }

}  // namespace config::schema
