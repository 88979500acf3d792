// A square column along z. Lengths in mm.
DefineConstant[
  n_side = {4, Name "elements across"}, n_len = {60, Name "elements along"},
  side = {10, Name "of the section"}, length = {120, Name "of the column"}
];
Point(1) = {-side / 2, -side / 2, 0};
Point(2) = {side / 2, -side / 2, 0};
Point(3) = {side / 2, side / 2, 0};
Point(4) = {-side / 2, side / 2, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
Transfinite Curve{1:4} = n_side + 1;
Transfinite Surface{1};
Recombine Surface{1};
out[] = Extrude {0, 0, length} { Surface{1}; Layers{n_len}; Recombine; };
Physical Volume("column") = {out[1]};
Physical Surface("foot") = {1};
Physical Surface("head") = {out[0]};
Physical Surface("sides") = {out[2], out[3], out[4], out[5]};
