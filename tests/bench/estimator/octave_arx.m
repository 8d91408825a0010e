% Fits ARX(4,4,1) to a record (u,y per line) with the control package: prints the shortest time in
% seconds, then a1..a4 b1..b4. Its "nk" counts from the first past input: nk 0 is a delay of 1.
pkg load control
data = csvread (argv (){1});
u = data(:,1);
y = data(:,2);
times = [];
for i = 1:10
  start = tic;
  sys = arx (iddata (y, u, 0.005), "na", 4, "nb", 4, "nk", 0);
  times(end+1) = toc (start);
end
[num, den] = tfdata (sys, "v");
printf ("%.9g\n", min (times));
printf ("%.17g ", den{1}(2:5), num{1}(1:4));
printf ("\n");
