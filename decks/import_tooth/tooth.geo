// Half of a gear's tooth with an involute flank: gmsh -2 tooth.geo -o tooth.msh        lengths in mm
module = 4;  teeth = 20;  pressure = 20*Pi/180;
pitch = module*teeth/2;  base = pitch*Cos(pressure);  tip = pitch + module;  root = pitch - 1.25*module;
// half of the tooth's angle at the base circle: at the pitch circle, and the involute of the pressure angle
half = Pi/(2*teeth) + Tan(pressure) - pressure;
last = Sqrt((tip/base)^2 - 1);                      // roll angle at the tip
n = 12;
Point(1) = {0, root, 0};
Point(2) = {root*Sin(half), root*Cos(half), 0};
Point(3) = {0, 0, 0};
Point(4) = {0, tip, 0};
For k In {0:n}
  t = last*k/n;
  r = base*Sqrt(1 + t^2);
  a = half - (t - Atan(t));
  Point(100 + k) = {r*Sin(a), r*Cos(a), 0};
EndFor
Circle(1) = {1, 3, 2};                              // root
Line(2) = {2, 100};                                 // below the base circle
Spline(3) = {100:100+n};                            // involute
Circle(4) = {100+n, 3, 4};                          // tip
Line(5) = {4, 1};                                   // middle of the tooth
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};
Transfinite Curve{1, 4} = 7;
Transfinite Curve{2} = 5;
Transfinite Curve{3} = 11 Using Progression 0.9;
Transfinite Curve{5} = 15 Using Progression 1.05;
Transfinite Surface{1} = {1, 2, 100+n, 4};
Recombine Surface{1};
Physical Curve("root") = {1};
Physical Curve("flank") = {2, 3};
Physical Curve("tip") = {4};
Physical Curve("middle") = {5};
Physical Surface("tooth") = {1};
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1;                     // 8 nodes, none in the middle
Mesh.MshFileVersion = 4.1;
