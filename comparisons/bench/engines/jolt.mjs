// Jolt (MIT licence, npm jolt-physics): a soft body of the edges of the exported file.  Collisions and damping are off.
import {main, packageFile, packageVersion} from './adapter.mjs';

await main(async (task, model) => {
  const {default: init} = await import(packageFile('jolt-physics', 'dist/jolt-physics.wasm-compat.js'));
  const Jolt = await init();
  const X = model.nodes.position_m, masses = Float64Array.from(model.nodes.mass_kg), n = masses.length;
  const held = new Set(task.pinned ? Object.values(model.pins).flat() : []);

  const settings = new Jolt.JoltSettings(), layers = new Jolt.ObjectLayerPairFilterTable(1);
  const broad = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
  broad.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
  settings.mObjectLayerPairFilter = layers;
  settings.mBroadPhaseLayerInterface = broad;
  settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 1, layers, 1);
  const jolt = new Jolt.JoltInterface(settings), system = jolt.GetPhysicsSystem();
  system.SetGravity(new Jolt.Vec3(...task.gravity_m_s2));

  const shared = new Jolt.SoftBodySharedSettings();
  for (let i = 0; i < n; ++i) {
    const vertex = new Jolt.SoftBodySharedSettingsVertex();
    vertex.mPosition = new Jolt.Float3(...X[i]);
    vertex.mInvMass = held.has(i) ? 0 : 1 / masses[i];
    shared.mVertices.push_back(vertex);
  }
  model.edges.nodes.forEach(([i, j], s) =>
    shared.mEdgeConstraints.push_back(new Jolt.SoftBodySharedSettingsEdge(i, j, model.edges.compliance_m_N[s])));
  shared.CalculateEdgeLengths();
  if (task.set_up === 'volumes') {  // compliance of 6 V: 36 V / K
    for (const [a, b, c, d] of model.tetrahedra.nodes)
      shared.mVolumeConstraints.push_back(new Jolt.SoftBodySharedSettingsVolume(a, b, c, d, task.volume_compliance));
    shared.CalculateVolumeConstraintVolumes();
  }
  shared.Optimize();
  const creation = new Jolt.SoftBodyCreationSettings(shared, new Jolt.RVec3(0, 0, 0), new Jolt.Quat(0, 0, 0, 1), 0);
  creation.mNumIterations = task.iterations;
  creation.mLinearDamping = 0;
  creation.mUpdatePosition = false;
  creation.mAllowSleeping = false;
  const body = system.GetBodyInterface().CreateSoftBody(creation);
  system.GetBodyInterface().AddBody(body.GetID(), Jolt.EActivation_Activate);

  // Vertices lie in WASM's memory in equal distances.
  const motion = Jolt.castObject(body.GetMotionProperties(), Jolt.SoftBodyMotionProperties);
  const traits = Jolt.SoftBodyVertexTraits.prototype;
  const first = Jolt.getPointer(motion.GetVertex(0)), stride = (Jolt.getPointer(motion.GetVertex(1)) - first) / 4;
  const at = i => first / 4 + i * stride;
  const all = offset => {
    const out = new Float64Array(3 * n);
    for (let i = 0; i < n; ++i) for (let c = 0; c < 3; ++c) out[3 * i + c] = Jolt.HEAPF32[at(i) + offset / 4 + c];
    return out;
  };
  const velocity = traits.get_mVelocityOffset(), position = traits.get_mPositionOffset();
  const setVelocities = v => {
    for (let i = 0; i < n; ++i)
      if (!held.has(i)) for (let c = 0; c < 3; ++c) Jolt.HEAPF32[at(i) + velocity / 4 + c] = v[3 * i + c];
  };
  return {
    name: `Jolt, npm jolt-physics ${packageVersion('jolt-physics')}`,
    masses,
    positions: () => all(position),
    velocities: () => all(velocity),
    setVelocities,
    step(dt, forces) {  // Jolt takes no force on a vertex: a push before each of its substeps
      if (!forces) return jolt.Step(dt, 1);
      motion.SetNumIterations(1);
      for (let i = 0, h = dt / task.iterations; i < task.iterations; ++i) {
        setVelocities(all(velocity).map((v, k) => v + h * forces[k] / masses[Math.floor(k / 3)]));
        jolt.Step(h, 1);
      }
    },
  };
});
