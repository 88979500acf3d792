// A rubber ring in the chamfer of a hub, on a shaft and a shoulder; x = r, y = z, lengths in mm
h = 0.12; R = 1.31; r0 = 15; 
Point(1) = {r0+R, R, 0, h}; Point(2) = {r0+2*R, R, 0, h}; Point(3) = {r0+R, 2*R, 0, h}; Point(4) = {r0, R, 0, h}; Point(5) = {r0+R, 0, 0, h};
Circle(1) = {2,1,3}; Circle(2) = {3,1,4}; Circle(3) = {4,1,5}; Circle(4) = {5,1,2};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Physical Surface("ring") = {1}; Physical Curve("skin") = {1:4};
// the shaft and its shoulder
Point(20) = {r0, 6, 0}; Point(21) = {r0, 0, 0}; Point(22) = {r0+6, 0, 0};
Line(20) = {20,21}; Line(21) = {21,22}; Transfinite Curve{20,21} = 30;
Physical Curve("corner") = {20,21};
// the hub: its chamfer touches the ring, on the line r + y = c
c = r0 + 2*R + R*Sqrt(2); g = 0.08;
Point(30) = {r0+g, c-r0-g, 0}; Point(31) = {c-0.35-0, 0.35, 0};
Point(32) = {r0+g, c-r0-g+2, 0}; Point(33) = {c-0.35+3, 0.35, 0};
Line(30) = {33,31}; Line(31) = {31,30}; Line(32) = {30,32}; Transfinite Curve{31} = 40; Transfinite Curve{30,32} = 10;
Physical Curve("hub") = {30:32};
