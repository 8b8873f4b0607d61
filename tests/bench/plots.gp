# The plots of docs/RESULTS.md, from its tables. In the root of the repository: gnuplot tests/bench/plots.gp
# One of them, from other tables: gnuplot -e "data='DIR'; out='DIR'; only='scaling'" tests/bench/plots.gp
if (!exists("data")) data = 'docs/data'
if (!exists("out")) out = 'assets'
if (!exists("only")) only = ''

# Okabe and Ito's colors, and shapes of their own: told apart also by who sees no colors.
set linetype 1 lc rgb '#6b6b6b' pt 4 ps 0.6 lw 1.5
set linetype 2 lc rgb '#0072b2' pt 6 ps 0.6 lw 1.5
set linetype 3 lc rgb '#d55e00' pt 8 ps 0.7 lw 1.5
METHODS = 'pt restir-pt rgb-restir'
begin(name, width, height) = sprintf("reset; set datafile separator comma; set encoding utf8; set terminal svg size %d,%d \
font 'Helvetica,Arial,sans-serif,12' background rgb 'white' enhanced; set output \"| sed -Ez 's#<g [^>]*>[[:space:]]*</g>[[:space:]]*##g; s# (stroke-line[a-z]*|class)=.[a-z]*.##g' > '%s/plot_%s.svg'\"; set border 3 lc rgb '#888888'; \
set tics nomirror scale 0.5,0 textcolor rgb '#222222'; set grid xtics ytics lc rgb '#e4e4e4' lw 1 lt 1", width, height, out, name)
# A panel that holds only the key.
KEY = "set lmargin 1; unset border; unset tics; unset xlabel; unset ylabel; unset title; unset grid; unset logscale; set xrange [0:1]; \
set yrange [0:1]; set key at graph 0,0.9 left top Left reverse samplen 2 spacing 1.5"

if (only eq '' || only eq 'autocovariance') {
    points = data.'/autocovariance.csv'
    laws = data.'/autocovariance_law.csv'
    eval begin('autocovariance', 960, 500)
    set multiplot layout 2,4
    set logscale xy
    set xrange [1.4:60000]
    set xtics (2, 32, 1024, 32768)
    set ytics 100
    set format y '10^{%L}'
    set lmargin 9
    set samples 60
    unset key
    array SCENES[7] = ['cornell', 'hall', 'lamps', 'dim', 'Sponza', 'Bistro at night', 'Victorian House']
    do for [i=1:7] {
        scene = SCENES[i]
        set yrange [*:*]
        stats laws using (strcol(1) eq scene ? $3 : NaN) every ::1 nooutput name 'V'
        stats laws using (strcol(1) eq scene ? $4 : NaN) every ::1 nooutput name 'P'
        is(k, kind) = strcol(1) eq scene && strcol(2) eq word(METHODS, k) && strcol(6) eq kind
        set title scene
        set xlabel (i > 4 ? 'M, frames of history' : '')
        set ylabel (i % 4 == 1 ? 'autocovariance, radiance²' : '')
        set yrange [V_max / 1e5 : V_max]
        plot [1.4:60000] (x < 2 ? NaN : V_max / x + (1 - 2 / x) * P_max) lt 2, (x < 2 ? NaN : V_max / x) lt 3, \
            for [k=2:3] points using (is(k, 'measured') ? $3 : NaN):4:(column(4) > column(5) ? $4 - $5 : 1e-12):($4 + $5) \
                every ::1 with yerrorbars lt k pt (k == 2 ? 7 : 9) ps 0.45, \
            for [k=2:3] points using (is(k, 'predicted') ? $3 : NaN):4 every ::1 with points lt k
    }
    eval KEY
    plot NaN with lines lt 2 title 'ReSTIR PT, closed form', NaN with points lt 2 pt 7 title 'measured, 95%', \
        NaN with points lt 2 title 'predicted', NaN with lines lt 3 title 'RGB ReSTIR, closed form', \
        NaN with points lt 3 pt 9 title 'measured, 95%', NaN with points lt 3 title 'predicted'
    unset multiplot
}

# What mutations of history's samples change: the film at rest, and how long frames are remembered under motion.
if (only eq '' || only eq 'mutations') {
    mutations = data.'/mutations.csv'
    eval begin('mutations', 960, 340)
    set linetype 4 lc rgb '#009e73' pt 4 ps 0.6 lw 1.5
    set multiplot layout 1,3
    set logscale xy
    set format y '10^{%L}'
    set lmargin 9
    unset key
    is(method, regime) = strcol(1) eq regime && strcol(2) eq method
    set title 'Mean of all frames, at rest, K = 0'
    set xlabel 'M, frames'
    set ylabel 'variance, radiance²'
    rest = 'cornell; rest; replay; K = 0'
    plot for [k=2:3] mutations using (is(k == 2 ? 'restir-pt (chosen)' : 'rgb-restir', rest) ? $3 : NaN):13 every ::1 with lines lt k dt 2, \
        for [k=2:3] mutations using (is(k == 2 ? 'restir-pt (chosen)' : 'rgb-restir', rest) ? $3 : NaN):12 every ::1 with points lt k, \
        mutations using (is('restir-pt (chosen; mutated)', rest) ? $3 : NaN):12 every ::1 with linespoints lt 4
    set title 'Frames under motion, K = 3'
    set xlabel 'lag, frames'
    set ylabel 'autocovariance, radiance²'
    moving = 'cornell; 0.3 degrees a frame; hybrid; K = 3'
    array NAMES[4] = ['', 'restir-pt (chosen)', 'rgb-restir', 'restir-pt (chosen; mutated)']
    row(name) = sprintf("< grep '^%s,%s,' '%s' | cut -d, -f5-11 | tr , '\\n'", moving, name, mutations)
    plot for [k=2:4] row(NAMES[k]) using (2 ** $0):1 with linespoints lt k, row('rgb-restir (mutated)') using (2 ** $0):1 with linespoints lt 3 pt 9 dt 3
    eval KEY
    plot NaN with linespoints lt 2 title 'ReSTIR PT', NaN with linespoints lt 4 title 'ReSTIR PT, mutated', \
        NaN with linespoints lt 3 title 'RGB ReSTIR', NaN with linespoints lt 3 pt 9 dt 3 title 'RGB ReSTIR, mutated', \
        NaN with lines lt -1 dt 2 title 'closed form'
    unset multiplot
}

# How many times less error, with intervals: a row for each comparison.
if (only eq '' || only eq 'ratios') {
    ratios = data.'/ratios.csv'
    eval begin('ratios', 960, 700)
    set multiplot layout 2,1
    set logscale x
    set xrange [0.4:40]
    set xtics (0.5, 1, 2, 4, 8, 16, 32)
    set lmargin 54
    set rmargin 2
    unset ytics
    unset key
    set arrow from 1, graph 0 to 1, graph 1 nohead lc rgb '#222222'
    do for [i=1:2] {
        set title (i == 1 ? 'The camera moves: a frame against a frame' : 'The camera moves: at equal time')
        set xlabel (i == 1 ? '' : 'times less relative MSE, with its 95% interval')
        condition = 'moving: equal '.(i == 1 ? 'frames' : 'time')
        set yrange [(i == 1 ? 11.6 : 16.6):0.4]
        has(k) = strcol(1) eq condition && strcol(7) ne '' && (i == 1 || strcol(4) eq 'restir-pt variate') && k == (strcol(5) eq 'pt' ? 1 : strstrt(strcol(5), 'weighted') ? 3 : 2)
        label(i) = strcol(3).': '.strcol(4).' over '.strcol(5).', '.strcol(2).' repeats'
        n = 0
        m = 0
        plot for [k=1:3] ratios using (has(k) ? (n = n + 1, $6) : NaN):(n):7:8 every ::1 with xerrorbars lt k pt 7 ps 0.5, \
            for [k=1:3] ratios using (has(k) ? (m = m + 1, 0.4) : NaN):(m):(label(0)) every ::1 with labels right offset -1,0
    }
    unset multiplot
}

# The worst tile of each case against its truth.
if (only eq '' || only eq 'extremes') {
    extremes = data.'/extremes.csv'
    eval begin('extremes', 760, 640)
    set termoption noenhanced
    set xrange [0:4.2]
    set yrange [43.6:0.4]
    set xlabel 'largest |z|, in standard errors (4 is the limit)'
    set key top center outside horizontal samplen 0
    set ytics font ',10' scale 0
    set arrow from 4, graph 0 to 4, graph 1 nohead lc rgb '#222222'
    plot extremes using 3:($0 + 1):ytic(1) every ::1 with points lt 1 title 'path tracer', \
        '' using 6:($0 + 1) every ::1 with points lt 2 title 'ReSTIR PT', '' using 9:($0 + 1) every ::1 with points lt 3 title 'RGB ReSTIR'
}

if (only eq '' || only eq 'scaling') {
    scaling = data.'/scaling.csv'
    eval begin('scaling', 960, 500)
    set multiplot layout 2,4
    unset key
    set ylabel 'ms a frame'
    array SERIES[7] = ['triangles', 'pixels', 'bounces', 'lights', 'confidence', 'neighbors', 'channels']
    array AXES[7] = ['triangles', 'pixels', 'bounces at most', 'emissive triangles', 'M_c, frames', 'K, neighbors', 'reservoirs a pixel']
    do for [i=1:7] {
        if (system("grep -c '^".SERIES[i].",' '".scaling."'") eq '0') { set multiplot next; continue }
        set xlabel AXES[i]
        is(method) = strcol(1) eq SERIES[i] && (method eq '' || strcol(2) eq method)
        set yrange [*:*]
        if (i <= 5) { set logscale xy } else { unset logscale; set yrange [0:*] }
        step = i == 3 ? 2 : i <= 5 ? 100 : 8 - i
        set xtics step
        set format x (i == 3 || i > 5 ? '%g' : '10^{%L}')
        if (i == 7) { plot scaling using (is('') ? $3 : NaN):4 every ::1 with linespoints lt -1 pt 7 ps 0.5 } \
        else { plot for [k=1:3] scaling using (is(word(METHODS, k)) ? $3 : NaN):4 every ::1 with linespoints lt k }
    }
    eval KEY
    plot for [k=1:3] NaN with linespoints lt k title word('"path tracer" "ReSTIR PT" "RGB ReSTIR"', k)
    unset multiplot
}
