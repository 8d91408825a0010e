// [[classifier]], experimental: which of several trained faults the values of an estimator
// resemble, or none. In the scorecard the fault named is the right one in 38 % of the alarms.
//
// Each class, healthy among them, is a normal distribution of the block means x (hotelling_t2.h);
// the class's own covariance is shrunk towards the pooled one by `pooling` (0: quadratic, 1: linear
// discriminant analysis).
//
//   P(class | x) = N(x; class) / sum over classes that do not reject x     (equal priors)
//   a class rejects x when its T^2 exceeds the limit for probability `rejection`
//   none of these when every class does
//
// A block that every class rejects is compared with fault sizes between the trained ones: classes
// of one name and direction, whose means lie one behind the other as seen from healthy, are sizes
// of one fault. Each also accepts blocks on the trajectory that leads to it from the next smaller
// size, the smallest from where the trajectory leaves the healthy region (fault_trajectory.h). A
// block that a class accepts is never reassigned by a trajectory. Beyond the greatest size only its
// own distribution counts.
//
// The alarm is raised after `confirm` consecutive blocks of one faulty class (or of none), names
// the class, and gives the classes of 5 % or more as ambiguity group when there are several.
// Source: T. Hastie, R. Tibshirani, J. Friedman, The Elements of Statistical Learning, 4.3; B. D.
// Ripley, Pattern Recognition and Neural Networks, 1996, 2.1 (doubt and outliers).
#pragma once

#include "estimator/fdi/trained.h"

namespace estimator::fdi {

/// Values: class (number in the list; between two sizes the greater's; -1: none of these),
/// probability, distance2 (T^2 of the nearest).
struct ClassifierConfig final : TrainedMethodConfig {
  std::vector<std::string> features;
  double rejection = 1e-4;  ///< share of a class's own blocks that is rejected
  double pooling = 0.1;
  std::int64_t confirm = 2;
  std::vector<TrainedClass> classes;
  AlarmNaming naming;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] std::vector<std::string> quantities() const override { return features; }
  [[nodiscard]] bool needs_classes() const override { return true; }
  void adopt(const TrainedMethod& trained) override { classes = trained.classes; }
  [[nodiscard]] const char* list() const override { return "classifier"; }
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
  [[nodiscard]] std::unique_ptr<DetectionMethodConfig> clone() const override {
    return std::make_unique<ClassifierConfig>(*this);
  }
};

}  // namespace estimator::fdi
