// Section of a disc spring (DIN 2093, B 50): axisymmetric, x is the radius. Lengths in mm.
De = 50;      // outer diameter
Di = 25.4;    // inner diameter
t = 2;        // thickness
h0 = 1.4;     // height of the cone
b = (De - Di) / 2;
angle = Asin(h0 / b);  // of the cone; the rectangle is turned about its middle
s = Sin(angle);
c = Cos(angle);
xm = (De + Di) / 4;
w = (b - t * s) / c;   // width of the rectangle, so that the radii are those of the corners
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
n_w = 24 * refine;
n_t = 4 * refine;
// corners: inner lower, outer lower, outer upper, inner upper
Point(1) = {xm - c * w / 2 - s * t / 2, s * w / 2 - c * t / 2, 0};
Point(2) = {xm + c * w / 2 - s * t / 2, -s * w / 2 - c * t / 2, 0};
Point(3) = {xm + c * w / 2 + s * t / 2, -s * w / 2 + c * t / 2, 0};
Point(4) = {xm - c * w / 2 + s * t / 2, s * w / 2 + c * t / 2, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n_w + 1;
Transfinite Curve{2, 4} = n_t + 1;
Transfinite Surface{1};
Recombine Surface{1};

Physical Surface("washer") = {1};
Physical Curve("under") = {1};
Physical Curve("over") = {3};
