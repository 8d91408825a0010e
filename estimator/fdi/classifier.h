// [[classifier]]: which of several trained faults the values of an estimator look like, or none.
//
// Each class, healthy among them, is a normal law of the block means x (region.h); the covariance
// is the class's own, drawn towards the pooled one by `pooling` (0: quadratic, 1: linear
// discriminant analysis).
//
//   P(class | x) = N(x; class) / sum over classes        (equal prior probabilities)
//   none of these when T^2 of every class exceeds its limit for probability `rejection`
//
// The alarm comes after `confirm` blocks in a row that are not healthy, names the class that they
// agree on, and gives the classes of 5 % or more as ambiguity group when there are several. A
// fault of another size than those of the training records is often none of these: train several
// sizes under one name, each is a law of its own.
// Source: T. Hastie, R. Tibshirani, J. Friedman, The Elements of Statistical Learning, 4.3; B. D.
// Ripley, Pattern Recognition and Neural Networks, 1996, 2.1 (doubt and outliers).
#pragma once

#include "estimator/fdi/trained.h"

namespace estimator::fdi {

/// Values: class (its number in the list, -1: none of these), probability, distance2 (of the
/// nearest).
struct ClassifierConfig final : TrainedConfig {
  std::vector<std::string> features;
  double rejection = 1e-4;  ///< share of a class's own blocks that is rejected
  double pooling = 0.1;
  std::int64_t confirm = 2;
  std::vector<TrainedClass> classes;
  AlarmNaming naming;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] std::vector<std::string> quantities() const override { return features; }
  [[nodiscard]] bool needs_classes() const override { return true; }
  void adopt(const TrainedSource& trained) override { classes = trained.classes; }
  [[nodiscard]] const char* list() const override { return "classifier"; }
  [[nodiscard]] std::unique_ptr<Source> make(const Setting& setting) const override;
  [[nodiscard]] std::unique_ptr<SourceConfig> clone() const override {
    return std::make_unique<ClassifierConfig>(*this);
  }
};

}  // namespace estimator::fdi
