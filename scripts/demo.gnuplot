# The picture of a demonstration: motion, loop error, and b1 against its band with the alarms.
# Use: gnuplot -e "folder='...'" scripts/demo.gnuplot; folder holds samples.csv, estimates.csv and
# alarms.csv as `spoolwatch export` writes them.
set terminal pngcairo size 1200,900 font "DejaVu Sans,11" background "#ffffff"
set output folder."/demo.png"
set datafile separator ","
samples = folder."/samples.csv"
estimates = folder."/estimates.csv"
alarms = folder."/alarms.csv"

set multiplot layout 3,1 margins 0.09,0.97,0.08,0.93 spacing 0.07 \
  title "{/:Bold Spoolwatch: supply pressure +25 % at 10 s, normal at 20 s, -25 % at 30 s}"
set grid linecolor "#dddddd" linetype 1
set border 3 linecolor "#666666"
set xtics nomirror
set ytics nomirror
set key top right horizontal opaque samplen 2
stats samples using 1 nooutput
end_s = STATS_max
set xrange [0:end_s]
do for [t in "10 20 30"] { set arrow from t,graph 0 to t,graph 1 nohead linecolor "#999999" dashtype 3 }

set ylabel "rod position, mm"
plot samples using 1:($4*1e3) with lines linewidth 2 linecolor "#9bb7d4" title "reference", \
     samples using 1:($3*1e3) with lines linewidth 1 linecolor "#1f3b57" title "position"

set ylabel "valve command, V"
plot samples using 1:2 with lines linewidth 1 linecolor "#1f3b57" notitle

set ylabel "b_1, 10^{-4} m/V"
set xlabel "time, s"
set yrange [1.55:2.4]
set object 1 rectangle from graph 0,first 1.8 to graph 1,first 2.1 behind \
  fillcolor "#e6f2e6" fillstyle solid noborder
set label 1 "normal band" at 0.3,2.075 textcolor "#4d7a4d"
pick(source) = sprintf("< awk -F, '$2==\"%s\" && $3==1 && $4==\"b1\" && $1>2' '%s'", source, estimates)
# An alarm's bar goes from the transition to active to the next to normal or to INVALID, where it is
# not known, or to the end.
bars(name) = sprintf("< awk -F, -v end=%f '$3==\"%s\" && !$6 { if ($5 && $4!=\"INVALID\") { if (from==\"\") from=$1 } else if (from!=\"\") { print from \",\" $1-from; from=\"\" } } END { if (from!=\"\") print from \",\" end-from }' '%s'", end_s, name, alarms)
plot pick("sliding") using 1:($5*1e4) with lines linewidth 2 linecolor "#d9822b" title "0.3 s sliding window", \
     pick("period") using 1:($5*1e4) with points pointtype 7 pointsize 1.1 linecolor "#1f3b57" title "one batch a period", \
     bars("supply_pressure_fast") using 1:(1.64):2:(0) with vectors nohead linewidth 6 linecolor "#d9822b" title "alarm, sliding", \
     bars("supply_pressure") using 1:(1.59):2:(0) with vectors nohead linewidth 6 linecolor "#b3261e" title "alarm, period"
unset multiplot
