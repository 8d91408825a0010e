// Printed by reference.py. Figures of the thesis's plant and loop by NumPy.
#pragma once

namespace workbench::reproduce::reference {

inline constexpr double kB1 = 1.967190615e-04;
inline constexpr double kPressureUp_percent = 4.949838674e+00;
inline constexpr double kPressureDown_percent = -5.207270443e+00;
inline constexpr double kDampingUp_percent = -7.536154699e-02;
inline constexpr double kDampingDown_percent = 7.530444065e-02;
inline constexpr double kPressureLow = 1.381386508e-04;
inline constexpr double kPressureHigh = 2.415173402e-04;
inline constexpr double kDampingLow = 1.959766825e-04;
inline constexpr double kDampingHigh = 1.974586319e-04;
inline constexpr double kCost111_m2 = 5.432690337e-08;
inline constexpr double kCostLate111_m2 = 2.909228560e-05;
inline constexpr double kCost211_m2 = 9.019854892e-09;
inline constexpr double kCostLate211_m2 = 2.913796081e-05;
inline constexpr double kCost311_m2 = 1.455036469e-09;
inline constexpr double kCostLate311_m2 = 2.902638774e-05;
inline constexpr double kCost411_m2 = 4.134298721e-09;
inline constexpr double kCostLate411_m2 = 2.907183652e-05;
inline constexpr double kCost221_m2 = 1.563859135e-10;
inline constexpr double kCostLate221_m2 = 2.900286087e-05;
/// m/V, of the periods that end at 14, 16, 18, 32, 46, 48 s.
inline constexpr double kCaseOneB1[] = {1.967190615e-04, 2.073723569e-04, 2.202581542e-04,
                                        1.967468227e-04, 1.819339441e-04, 1.699600936e-04};
/// m/V, of the periods that end at 14, 16, 18, 32, 46, 48 s.
inline constexpr double kCaseTwoB1[] = {1.967190615e-04, 1.965186970e-04, 1.963482242e-04,
                                        1.967338264e-04, 1.969186872e-04, 1.970891966e-04};

}  // namespace workbench::reproduce::reference
