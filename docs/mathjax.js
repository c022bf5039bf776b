MathJax.Hub.Config({ messageStyle: "none", showMathMenu: false, SVG: { blacker: 0, scale: 95 } });
