// A user's own effect as a model file declares it: where it acts, its formula, its parameters with
// their ranges. Whether it acts, and with which values, stands in [effects.NAME] as for an effect
// of the library; declared only, it is a candidate. TOML:
//
//   [formula_effects.cubic_drag]
//   site = "force"
//   formula = "c_N_s3_per_m3 * v_mps^3"
//   what = "drag of the seals"
//   [formula_effects.cubic_drag.parameters.c_N_s3_per_m3]
//   what = "force per speed cubed"
//   min = 0.0
//   max = 1e7
//   typical = 2.5e5
//   neutral = 0.0                # with every parameter neutral the effect has no influence
//
//   [effects.cubic_drag]         # presence adds it
//   c_N_s3_per_m3 = 1.2e5
//
// By site, the formula gives, from variables of the site:
//   command   the command to the valve, V              u_V
//   opening   the valve opening from spool position    x_m (of velocity_servo: speed, m/s), y_m
//   flow      the flow of one orifice, m3/s            q_m3ps
//   leakage   what leaks from chamber i to o, m3/s     in_Pa, out_Pa
//   force     a force against extension, N             y_m, v_mps
//   dry_friction  rise of all dry friction, a share    y_m, v_mps
//   sensor    what the position sensor shows, m        y_m
// and from the plant's other signals (signals.h). It acts after the library's effects of its site,
// in the order of declaration. With one line more it has a memory z, which starts at 0:
//
//   memory = "(abs(v_mps) - z) / warm_s"                 # dz/dt: here a lag, a hidden level
//   formula = "drop_N_s_per_m * v_mps * z"
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plant_sim/effects/site.h"
#include "plant_sim/formula/signals.h"

namespace config::schema {
class Visitor;
}

namespace plant_sim::formula {

/// A curve in the place of a formula (curve_effect.h), over one signal and perhaps times another.
struct CurveTable {
  std::string over;
  std::string times;  ///< empty: none
  std::vector<double> x;
  std::vector<double> f;  ///< as declared: the model's effect has its values
};

struct FormulaEffect {
  struct Parameter {
    std::string name;
    std::string what;
    double min = 0.0;
    double max = 0.0;
    double typical = 0.0;
    double neutral = 0.0;

    void visit(config::schema::Visitor& v);
  };

  std::string name;
  std::string site = "force";
  std::string formula;
  std::string what;
  std::vector<Parameter> parameters;
  std::string memory;  ///< dz/dt; empty: none
  /// Where the file has a table in the place of a formula, which is derived from it.
  std::optional<CurveTable> curve;

  /// The formula, or in words that it is a curve.
  [[nodiscard]] std::string equation() const;

  void visit(config::schema::Visitor& v);

 private:
  void visit_curve(config::schema::Visitor& v);
};

/// A site that accepts a formula.
struct FormulaSite {
  effects::Site site;
  const char* result;  ///< result of the formula, as printed in equations
  Signal first;        ///< the site's own variable
  Signal second;       ///< another that it goes with; the same: none
  bool chained;        ///< without influence it returns its own variable; else 0, and it is added
  double guard;        ///< numerical bound of the result, far beyond anything real
};

inline constexpr std::array kFormulaSites = {
    FormulaSite{effects::Site::command, "u_out", kCommand, kCommand, true, 1e4},
    FormulaSite{effects::Site::opening, "opening", kSpool, kPosition, true, 1e6},
    FormulaSite{effects::Site::flow, "Q", kFlow, kFlow, true, 1e3},
    FormulaSite{effects::Site::leakage, "Q", kInPressure, kOutPressure, false, 1e3},
    FormulaSite{effects::Site::force, "F", kPosition, kSpeed, false, 1e9},
    FormulaSite{effects::Site::dry_friction, "rise", kPosition, kSpeed, false, 1e3},
    FormulaSite{effects::Site::sensor, "reading", kPosition, kPosition, true, 1e9},
};

/// Null for a site that accepts no formula.
[[nodiscard]] const FormulaSite* find_formula_site(std::string_view name);

}  // namespace plant_sim::formula
