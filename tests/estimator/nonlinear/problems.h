// Problems for the minimiser whose answers are known from elsewhere.
//
// nist(): the National Institute of Standards and Technology's Statistical Reference Datasets for
// non-linear regression (www.itl.nist.gov/div898/strd): data, starts, certified parameters,
// their standard deviations and the residual sum of squares. MGH10 without its first start, which
// only thousands of steps leave. BoxBOD with a bound on its rate, beyond which the curve is flat.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "estimator/nonlinear/problem.h"

namespace estimator::nonlinear::testing_problems {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

inline VectorXd vec(const std::vector<double>& v) {
  return Eigen::Map<const VectorXd>(v.data(), static_cast<Index>(v.size()));
}

/// model(b, x) against y, one column at a time; counts calls and checks the lanes.
inline Problem curve(const std::function<double(const VectorXd&, double)>& model, const VectorXd& x,
                     const VectorXd& y, Index unknowns) {
  Problem out;
  out.residuals = x.size();
  out.unknowns.resize(static_cast<std::size_t>(unknowns));
  out.evaluate = [=](const MatrixXd& points, MatrixXd& residuals) {
    for (Index k = 0; k < points.cols(); ++k) {
      for (Index i = 0; i < x.size(); ++i) residuals(i, k) = y[i] - model(points.col(k), x[i]);
    }
  };
  return out;
}

/// r = y - A x
inline Problem linear(const MatrixXd& A, const VectorXd& y) {
  Problem out;
  out.residuals = A.rows();
  out.unknowns.resize(static_cast<std::size_t>(A.cols()));
  for (Unknown& unknown : out.unknowns) unknown.step = 1e-3;
  out.evaluate = [=](const MatrixXd& points, MatrixXd& residuals) {
    residuals = (-(A * points)).colwise() + y;
  };
  return out;
}

struct Certified {
  std::string name;
  Problem problem;
  std::vector<VectorXd> starts;
  VectorXd value;
  VectorXd standard_deviation;
  double sum_of_squares = 0.0;
};

inline std::vector<Certified> nist() {
  std::vector<Certified> out;
  const auto add = [&](std::string name, const std::function<double(const VectorXd&, double)>& f,
                       const std::vector<double>& x, const std::vector<double>& y,
                       const std::vector<std::vector<double>>& starts,
                       const std::vector<double>& value, const std::vector<double>& sd,
                       double rss) {
    Certified c;
    c.name = std::move(name);
    c.problem = curve(f, vec(x), vec(y), static_cast<Index>(value.size()));
    for (const auto& start : starts) c.starts.push_back(vec(start));
    c.value = vec(value);
    c.standard_deviation = vec(sd);
    c.sum_of_squares = rss;
    out.push_back(std::move(c));
  };
  add(
      "Misra1a", [](const VectorXd& b, double x) { return b[0] * (1 - std::exp(-b[1] * x)); },
      {77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1,
       760.0},
      {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47,
       81.78},
      {{500, 0.0001}, {250, 0.0005}}, {2.3894212918E+02, 5.5015643181E-04},
      {2.7070075241E+00, 7.2668688436E-06}, 1.2455138894E-01);
  add(
      "MGH09",
      [](const VectorXd& b, double x) {
        return b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]);
      },
      {4, 2, 1, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625},
      {0.1957, 0.1947, 0.1735, 0.16, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246},
      {{25, 39, 41.5, 39}, {0.25, 0.39, 0.415, 0.39}},
      {1.9280693458E-01, 1.9128232873E-01, 1.2305650693E-01, 1.3606233068E-01},
      {1.1435312227E-02, 1.9633220911E-01, 8.0842031232E-02, 9.0025542308E-02}, 3.0750560385E-04);
  add(
      "Thurber",
      [](const VectorXd& b, double x) {
        return (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) /
               (1 + x * (b[4] + x * (b[5] + x * b[6])));
      },
      {-3.067, -2.981, -2.921, -2.912, -2.840, -2.797, -2.702, -2.699, -2.633, -2.481,
       -2.363, -2.322, -1.501, -1.460, -1.274, -1.212, -1.100, -1.046, -0.915, -0.714,
       -0.566, -0.545, -0.400, -0.309, -0.109, -0.103, 0.010,  0.119,  0.377,  0.790,
       0.963,  1.006,  1.115,  1.572,  1.841,  2.047,  2.200},
      {80.574,   84.248,   87.264,   87.195,   89.076,   89.608,   89.868,   90.101,
       92.405,   95.854,   100.696,  101.060,  401.672,  390.724,  567.534,  635.316,
       733.054,  759.087,  894.206,  990.785,  1090.109, 1080.914, 1122.643, 1178.351,
       1260.531, 1273.514, 1288.339, 1327.543, 1353.863, 1414.509, 1425.208, 1421.384,
       1442.962, 1464.350, 1468.705, 1447.894, 1457.628},
      {{1000, 1000, 400, 40, 0.7, 0.3, 0.03}, {1300, 1500, 500, 75, 1, 0.4, 0.05}},
      {1.2881396800E+03, 1.4910792535E+03, 5.8323836877E+02, 7.5416644291E+01, 9.6629502864E-01,
       3.9797285797E-01, 4.9727297349E-02},
      {4.6647963344E+00, 3.9571156086E+01, 2.8698696102E+01, 5.5675370270E+00, 3.1333340687E-02,
       1.4984928198E-02, 6.5842344623E-03},
      5.6427082397E+03);
  add(
      "MGH10", [](const VectorXd& b, double x) { return b[0] * std::exp(b[1] / (x + b[2])); },
      {50, 55, 60, 65, 70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120, 125},
      {34780, 28610, 23650, 19630, 16370, 13720, 11540, 9744, 8261, 7030, 6005, 5147, 4427, 3820,
       3307, 2872},
      {{0.02, 4000, 250}}, {5.6096364710E-03, 6.1813463463E+03, 3.4522363462E+02}, {},
      8.7945855171E+01);
  add(
      "BoxBOD", [](const VectorXd& b, double x) { return b[0] * (1 - std::exp(-b[1] * x)); },
      {1, 2, 3, 5, 7, 10}, {109, 149, 149, 191, 213, 224}, {{1, 1}, {100, 0.75}},
      {2.1380940889E+02, 5.4723748542E-01}, {}, 1.1680088766E+03);
  add(
      "Rat43",
      [](const VectorXd& b, double x) {
        return b[0] / std::pow(1 + std::exp(b[1] - b[2] * x), 1 / b[3]);
      },
      {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
      {16.08, 33.83, 65.80, 97.20, 191.55, 326.20, 386.87, 520.53, 590.03, 651.92, 724.93, 699.56,
       689.96, 637.56, 717.41},
      {{100, 10, 1, 1}, {700, 5, 0.75, 1.3}},
      {6.9964151270E+02, 5.2771253025E+00, 7.5962938329E-01, 1.2792483859E+00}, {},
      8.7864049080E+03);
  for (Certified& c : out) {
    if (c.name == "BoxBOD") c.problem.unknowns[1].upper = 5.0;
  }
  return out;
}

/// Numbers from the normal distribution.
struct Draw {
  std::mt19937_64 engine;
  std::normal_distribution<double> normal;
  explicit Draw(std::uint64_t seed) : engine(seed) {}
  double operator()() { return normal(engine); }
  MatrixXd matrix(Index rows, Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(engine); });
  }
};

}  // namespace estimator::nonlinear::testing_problems
