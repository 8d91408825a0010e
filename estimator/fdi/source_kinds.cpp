// The table of the kinds of sources: a kind more is a line more.
#include <array>

#include "estimator/fdi/classifier.h"
#include "estimator/fdi/cusum.h"
#include "estimator/fdi/distance.h"
#include "estimator/fdi/glr.h"
#include "estimator/fdi/observer.h"
#include "estimator/fdi/polynomial_source.h"
#include "estimator/fdi/trend.h"
#include "estimator/fdi/voter.h"

namespace estimator::fdi {
namespace {

constexpr std::array kSourceKinds{
    source_kind<CusumConfig>("cusum", "tests for a change of mean of known size"),
    source_kind<GlrConfig>("glr", "tests for a change of mean of any size"),
    source_kind<DistanceConfig>("distance", "distances from a trained healthy region"),
    source_kind<ClassifierConfig>("classifier", "trained faults told apart"),
    source_kind<PolynomialConfig>("polynomial", "ARMAX, output error, Box-Jenkins on line"),
    source_kind<TrendConfig>("trend", "slow drifts, with the time to a limit"),
    source_kind<ObserverConfig>("observer", "observers, and banks of them, on a linear model"),
    source_kind<VoterConfig>("voter", "redundant channels, by vote"),
};

}  // namespace

std::span<const SourceKind> source_kinds() noexcept { return kSourceKinds; }

}  // namespace estimator::fdi
