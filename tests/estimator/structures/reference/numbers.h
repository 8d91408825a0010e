// Written by make_numbers.py: do not edit.
#pragma once

namespace estimator::structures::reference {

// Armax: SciPy's least_squares on errors filtered by lfilter.
inline constexpr double kArmax[] = {-1.5011818659802074, 0.7009156363315455,  0.5004256423655193,
                                    0.29847263148608366, -0.8067250607367602, 0.28420199178477024};
inline constexpr double kArmaxStdError[] = {0.001787542339963474,  0.0016518319699677076,
                                            0.0025547935133393646, 0.003220056041195461,
                                            0.024892184901755047,  0.02485447995987204};
inline constexpr double kArmaxRms[] = {0.02905670923908438};
// OutputError: SciPy's least_squares on errors filtered by lfilter.
inline constexpr double kOutputError[] = {0.49797674486213955, 0.2959005648414389,
                                          -1.2030216209522624, 0.5021922373671711,
                                          0.22661804893966836, 0.31515384652769196};
inline constexpr double kOutputErrorStdError[] = {0.007986112661193341, 0.013168758371413538,
                                                  0.008210654342164296, 0.006309875566455193,
                                                  0.27021664962070074,  0.1584236029173352};
inline constexpr double kOutputErrorRms[] = {0.09150835722725889};
// BoxJenkins: SciPy's least_squares on errors filtered by lfilter.
inline constexpr double kBoxJenkins[] = {
    0.5001911312949303,  0.29925291370521745, 0.5164256380248067,   -0.8844747000109169,
    -1.2000384302629916, 0.49895666089178775, -0.02334695387015291, 0.18788693404310514};
inline constexpr double kBoxJenkinsStdError[] = {
    0.002536785991602457,  0.0032342603084296335, 0.02308114213793802, 0.012609857261372823,
    0.0038307292250321806, 0.003906987760171836,  0.14647738492247048, 0.05425987867279386};
inline constexpr double kBoxJenkinsRms[] = {0.029005214518637742};
// ARX(2,2,1) of the ARMAX data: Octave control, arx(dat, 'na', 2, 'nb', 2); a, b.
inline constexpr double kOctaveArx[] = {-1.489678131459187, 0.6900914463890964, 0.5006414159784923,
                                        0.3041803874891702};
// Order 2 from the ARMAX data: SLICOT by n4sid and moen4 (s = 15 block rows); a, b, c.
inline constexpr double kOctave_n4sid[] = {-1.5018335722218596, 0.7013382064558253,
                                           0.5025774918914986,  0.29601117205756866,
                                           -0.8561874021978879, 0.33608972686731564};
inline constexpr double kOctave_moen4[] = {-1.5018335722218588, 0.7013382064558247,
                                           0.5025774918914956,  0.29601117205757055,
                                           -0.8561874021978881, 0.33608972686731586};
// Two-stage least squares (NumPy), instruments u(t-1) .. u(t-8).
inline constexpr double kTwoStage[] = {-1.500199760612891, 0.699946806524986, 0.5005934670697231,
                                       0.2994272832824648};
inline constexpr double kTwoStageLeastSquares[] = {-1.4895895376844472, 0.6899772613929608,
                                                   0.5005801505303691, 0.3044492076918016};
inline constexpr double kTwoStageStatistic[] = {35.71300697489277};

}  // namespace estimator::structures::reference
