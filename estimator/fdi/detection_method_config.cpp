#include "estimator/fdi/detection_method_config.h"

#include <array>

#include "config/schema/document.h"
#include "estimator/fdi/classifier.h"
#include "estimator/fdi/cusum.h"
#include "estimator/fdi/glr.h"
#include "estimator/fdi/hotelling_t2.h"
#include "estimator/fdi/observer.h"
#include "estimator/fdi/polynomial_method.h"
#include "estimator/fdi/snapshot.h"
#include "estimator/fdi/trend.h"
#include "estimator/fdi/voter.h"

namespace estimator::fdi {
namespace {

constexpr std::array kDetectionMethodKinds{
    detection_method_kind<CusumConfig>("cusum", "tests for a change of mean of known size"),
    detection_method_kind<GlrConfig>("glr", "tests for a change of mean of any size"),
    detection_method_kind<HotellingT2Config>("distance", "distances from a trained healthy region"),
    detection_method_kind<ClassifierConfig>(
        "classifier", "experimental: which trained fault the values resemble"),
    detection_method_kind<PolynomialConfig>("polynomial",
                                            "ARMAX, output error, Box-Jenkins on line"),
    detection_method_kind<TrendConfig>("trend",
                                       "experimental: slow drift, with the time to a limit"),
    detection_method_kind<ObserverConfig>("observer",
                                          "observers, and banks of them, on a linear model"),
    detection_method_kind<VoterConfig>("voter", "redundant channels, by vote"),
};

}  // namespace

std::span<const DetectionMethodKind> detection_method_kinds() noexcept {
  return kDetectionMethodKinds;
}

std::string DetectionMethodConfig::fingerprint() const {
  const std::unique_ptr<DetectionMethodConfig> copy = clone();
  copy->id.clear();
  return one_line(config::schema::print_toml([&](config::schema::Visitor& v) { copy->visit(v); }));
}

DetectionMethodList::DetectionMethodList(const DetectionMethodList& other) : kind(other.kind) {
  for (const auto& item : other.items) items.push_back(item->clone());
}

DetectionMethodList& DetectionMethodList::operator=(const DetectionMethodList& other) {
  DetectionMethodList copy(other);
  *this = std::move(copy);
  return *this;
}

void DetectionMethodList::visit(config::schema::Visitor& v) {
  const config::schema::Key key{kind.list, kind.description};
  items.resize(v.list(key, items.size()));
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!items[i]) items[i] = kind.make();
    v.element(key, i, [&](config::schema::Visitor& e) { items[i]->visit(e); });
  }
}

}  // namespace estimator::fdi
