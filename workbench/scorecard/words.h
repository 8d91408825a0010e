// Figures of a scorecard in words, for terminal and page alike.
#pragma once

#include <string>
#include <vector>

#include "workbench/scorecard/card.h"

namespace workbench::scorecard {

[[nodiscard]] std::string alarms_words(const QuietFigures& q);  ///< "2 in 12 h"
[[nodiscard]] std::string unusable_words(const std::string& motion, const std::string& why);
[[nodiscard]] std::string rate_words(const QuietFigures& q);    ///< "0.17 (< 0.52)"
[[nodiscard]] std::string benign_words(const QuietFigures& q);  ///< "1.3 per h", "12 % of the time"
[[nodiscard]] std::string share_words(int count, int of);       ///< "97 %"
[[nodiscard]] std::string fault_words(const Fault& fault);      ///< "supply pressure"
[[nodiscard]] std::string sized_words(const Fault& fault);      ///< "supply pressure, ±10 %"
[[nodiscard]] std::string stated_words(const Fault& fault);     ///< "10 %"
[[nodiscard]] std::string size_words(const FaultFigures::Smallest& smallest);
/// Smallest detected size for each motion: "0.5 / 0.5 / > 50 %".
[[nodiscard]] std::string smallest_words(const Card& card, const MethodFigures& method,
                                         const Fault& fault);
/// "1.2 (2.4) s"; "–" where fewer were detected.
[[nodiscard]] std::string delay_words(const MethodFigures& method, const Fault& fault);
[[nodiscard]] std::string first_words(const FaultFigures& of);
/// Definition of "detected".
[[nodiscard]] std::string detected_words(const Card& card);

/// Every fault that some method was tried on, in the order of the plan.
[[nodiscard]] std::vector<const Fault*> faults_of(const Card& card);
[[nodiscard]] const FaultFigures* figures_of(const MethodFigures& method, const Fault& fault);

}  // namespace workbench::scorecard
