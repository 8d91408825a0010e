// A law that is known as a curve: a table instead of a formula. TOML:
//
//   [curve_effects.seal_drag]
//   site = "force"                      # as of a formula (formula_effect.h)
//   over = "v_mps"                      # a signal that the site can see (signals.h)
//   times = "y_m"                       # optional: a further signal, by which the curve is
//   multiplied x = [-0.1, -0.05, 0.0, 0.05, 0.1]   # ascending f = [-90.0, -20.0, 0.0, 20.0, 90.0]
//   # the curve there, in the site's unit (per unit of `times`)
//
// Between the points the curve is a cubic with a continuous slope,
//
//   f(x_i + t h) = f_i + t (g + t ((3 d - 2 g - e) + t (g + e - 2 d))),
//   d = f_i+1 - f_i,  g = h m_i,  e = h m_i+1,  m_i = (f_i+1 - f_i-1)/(x_i+1 - x_i-1)
//
// (at the ends m is the slope of the last interval), and beyond the ends it is constant. The curve
// is added to what the site has without it. It becomes a formula whose parameters f1, f2, ... are
// the values at the points: it is simulated and fitted as other effects are; a value that is
// exactly 0 stays so in a fit. Source for the slopes: E. Catmull, R. Rom, A class of local
// interpolating splines, Computer Aided Geometric Design (1974) 317.
#pragma once

#include <string>

#include "plant_sim/formula/formula_effect.h"

namespace plant_sim::formula {

/// Derives formula and parameters of an effect from its table: sizes are those of the table's
/// values, either sign.
void derive_formula(FormulaEffect& curve);

/// Throws config::schema::ConfigError for a table that is no curve; `where` is the table in a file.
void check_points(const FormulaEffect& curve, const std::string& where);

}  // namespace plant_sim::formula
