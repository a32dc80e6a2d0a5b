// What the point cloud needs of three.js
export {
    BufferAttribute,
    BufferGeometry,
    PerspectiveCamera,
    Points,
    PointsMaterial,
    Scene,
    WebGLRenderer,
} from 'three';
export { OrbitControls } from 'three/addons/controls/OrbitControls.js';
