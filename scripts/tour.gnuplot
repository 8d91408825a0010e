# The picture of the guided tour: the rod against both models, their errors, the falling error.
# Use: gnuplot -e "folder='...'; picture='F.png'; floor_um=2.5" scripts/tour.gnuplot; scripts/tour
# writes time.txt (s; measured, model file, better model in mm; both errors in um) and steps.txt.
set terminal pngcairo size 1200,760 font "DejaVu Sans,11" background "#ffffff"
set output picture
time = folder."/time.txt"
steps = folder."/steps.txt"

set multiplot title "{/:Bold A model file against a record: what was missing, and the error without it}"
set grid linecolor "#dddddd" linetype 1
set border 3 linecolor "#666666"
set xtics nomirror
set ytics nomirror
set key top left horizontal opaque samplen 2 width -2

set lmargin at screen 0.07
set rmargin at screen 0.975
set tmargin at screen 0.93
set bmargin at screen 0.55
set offsets 0, 0, 18, 0
set ylabel "rod position, mm"
plot time using 1:3 with lines linewidth 1.5 linecolor "#d9822b" title "model file, free run", \
     time using 1:4 with lines linewidth 4 linecolor "#8fd3b4" title "better model, free run", \
     time using 1:2 with lines linewidth 1 linecolor "#1f3b57" title "measured"

set offsets 0, 0, 0, 0
set rmargin at screen 0.56
set tmargin at screen 0.46
set bmargin at screen 0.09
set logscale y
set format y "10^{%T}"
set yrange [0.5:1e4]
set ylabel "error, µm"
set xlabel "time, s"
plot time using 1:(abs($5)) with lines linewidth 1 linecolor "#d9822b" title "only parameters fitted", \
     time every 2 using 1:(abs($6)) with points pointtype 7 pointsize 0.2 linecolor "#2a9d6f" notitle, \
     NaN with points pointtype 7 linecolor "#2a9d6f" title "better model", \
     floor_um with lines linewidth 1.5 dashtype 2 linecolor "#b3261e" title sprintf("noise floor %.2g µm", floor_um)

set lmargin at screen 0.64
set rmargin at screen 0.975
set format y "10^{%T}"
set xlabel " "
set ylabel "held-out error, µm"
set xrange [-0.5:3.5]
set xtics rotate by 0 font ",9"
unset key
set boxwidth 0.55
set style fill solid
label_of(v) = v < 10 ? sprintf("%.2f", v) : v < 100 ? sprintf("%.1f", v) : sprintf("%.0f", v)
at_(s) = strstrt(s, "_")
bare(s) = at_(s) ? s[:at_(s)-1]." ".bare(s[at_(s)+1:]) : s
short(s) = s eq "model file as it is" ? "model file" : s eq "its parameters fitted" ? "fitted" : bare(s)
plot steps using 1:2:xtic(short(strcol(3))) with boxes linecolor "#6f95bd", \
     steps using 1:($2*1.5):(label_of($2)) with labels, \
     floor_um with lines linewidth 1.5 dashtype 2 linecolor "#b3261e"
unset multiplot
