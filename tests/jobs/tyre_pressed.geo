// A quarter of a hollow tyre: ring radius 100, section of radii 20 and 24, open at the rim over 100 degrees. The wheel's
// axis is z, the road is below; z = 0 is the middle plane. The half of its arc that meets the road is finer.
DefineConstant[
  refine = {1, Name "divides all element sizes"}
];
ring = 100; inside = 20; outside = 24; end = 130*Pi/180;
Point(1) = {0, -ring - inside, 0};
Point(2) = {0, -ring - outside, 0};
Point(3) = {0, -ring - inside*Cos(end/2), inside*Sin(end/2)};
Point(4) = {0, -ring - outside*Cos(end/2), outside*Sin(end/2)};
Point(5) = {0, -ring - inside*Cos(end), inside*Sin(end)};
Point(6) = {0, -ring - outside*Cos(end), outside*Sin(end)};
Point(7) = {0, -ring, 0};
Line(1) = {1, 2};
Circle(2) = {2, 7, 4};
Circle(3) = {4, 7, 6};
Line(4) = {6, 5};
Circle(5) = {5, 7, 3};
Circle(6) = {3, 7, 1};
Line(7) = {4, 3};
Curve Loop(1) = {1, 2, 7, 6};  Plane Surface(1) = {1};
Curve Loop(2) = {-7, 3, 4, 5};  Plane Surface(2) = {2};
Transfinite Curve{1, 4, 7} = Round(1.4*refine) + 1;
Transfinite Curve{2, 6} = Round(5.6*refine) + 1;
Transfinite Curve{3, 5} = Round(2.8*refine) + 1;
Transfinite Surface{1, 2};
Recombine Surface{1, 2};
near[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi/4} { Surface{1, 2}; Layers{Round(9.8*refine)}; Recombine; };
far[] = Extrude {{0, 0, 1}, {0, 0, 0}, 3*Pi/4} { Surface{near[0], near[6]}; Layers{Round(7*refine)}; Recombine; };
Physical Volume("tyre") = {near[1], near[7], far[1], far[7]};
Physical Surface("front") = {1, 2, far[0], far[6]};
Physical Surface("middle") = {near[2], far[2]};
Physical Surface("tread") = {near[3], near[9], far[3], far[9]};
Physical Surface("rim") = {near[10], far[10]};
Physical Surface("inner") = {near[5], near[11], far[5], far[11]};
