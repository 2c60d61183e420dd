//! Files that contain every element and attribute that the tables honour.

type File = (&'static str, String);

pub(super) fn mjcf() -> Vec<File> {
    let pulling = "<motor tendon='d'/>";
    let actuators: String = [
        "general",
        "motor",
        "position",
        "velocity",
        "intvelocity",
        "orientation",
        "pid",
        "damper",
        "cylinder",
        "muscle",
        "adhesion",
        "dcmotor",
        "plugin",
    ]
    .iter()
    .map(|tag| {
        format!(
            "<{tag} name='{tag}' joint='j1' gear='2' armature='0.1' damping='0.1'/>\
             <{tag} class='main' jointinparent='j2'/>"
        )
    })
    .collect();
    let passive: String = ["flex", "flexvert", "flexstrain", "distance"]
        .iter()
        .map(|tag| format!("<{tag} class='main' active='false'/>"))
        .collect();
    let robot = format!(
        "<mujoco model='all'>
        <compiler angle='radian' eulerseq='xyz' coordinate='local' autolimits='true' inertiafromgeom='auto'
          inertiagrouprange='0 5' settotalmass='4' boundmass='0.1' boundinertia='1e-4' balanceinertia='true'
          fusestatic='false' assetdir='a' meshdir='b' strippath='true'/>
        <option gravity='0 0 -9'><flag gravity='enable'/></option>
        <default><joint damping='0.1'/><default class='inner'><geom density='500'/></default></default>
        <asset><mesh name='x' class='main' file='x.obj' scale='1 1 1' refpos='0 0 0' refquat='1 0 0 0' inertia='exact'/>
          <mesh name='y' vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='0 2 1 0 1 3 1 2 3 0 3 2'/><mesh builtin='sphere'/></asset>
        <include file='included.xml'/>
        <worldbody><body name='a' childclass='inner' euler='0 0 0.1' gravcomp='0'>
          <joint name='j1' class='main' type='hinge' pos='0 0 0' axis='0 1 0' range='-1 1' limited='true' ref='0'
            springref='0.1' stiffness='1' damping='0.1' frictionloss='0.1' armature='0.1' springdamper='0.1 1'
            actuatorgravcomp='false'/>
          <frame pos='0.1 0 0'><geom type='box' size='0.1 0.1 0.1' mass='1' group='1'/></frame>
          <geom type='capsule' fromto='0 0 0 0 0 1' size='0.1' shellinertia='false'/><geom type='mesh' mesh='y'/><site name='s' class='main'/>
          <body name='b'><joint name='j2'/><inertial pos='0 0 0' mass='1' fullinertia='1 1 1 0 0 0'/>
            <body name='c'><joint name='j3'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><site name='t'/></body>
          </body>
        </body>
        <body name='free'><freejoint name='f'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody>
        <equality>
          <connect name='c' class='main' site1='s' site2='t'/><connect body1='a' body2='b' anchor='0 0 0'/>
          <weld name='w' class='main' active='true' site1='s' site2='t'/>
          <weld body1='a' body2='b' anchor='0 0 0' relpose='0 0 0 1 0 0 0'/>
          <joint name='e' class='main' joint1='j3' joint2='j2' polycoef='0 1'/>{passive}
          <tendon class='main' active='true' tendon1='d' tendon2='e' polycoef='0 1'/>
        </equality>
        <tendon><fixed name='d' class='main' stiffness='0' damping='0' frictionloss='0' armature='0'><joint joint='j2'
          coef='1'/></fixed><fixed name='e'><joint joint='j1' coef='2'/></fixed><spatial name='h'><site site='s'/><site site='t'/></spatial></tendon>
        <actuator>{actuators}{pulling}</actuator></mujoco>"
    );
    let included = "<mujocoinclude><option gravity='0 0 -9.81'/></mujocoinclude>";
    vec![("robot.xml", robot), ("included.xml", included.to_owned())]
}

pub(super) fn urdf() -> Vec<File> {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><origin xyz='0 0 0' rpy='0 0 0'/><mass value='1'/>
             <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>"
        )
    };
    let joint = |name: &str, [parent, child]: [&str; 2], more: &str| {
        format!(
            "<joint name='{name}' type='revolute'><parent link='{parent}'/><child link='{child}'/><axis xyz='0 0 1'/>
             <dynamics damping='0.1' friction='0.1'/><limit lower='-1' upper='1' velocity='2'/>{more}</joint>"
        )
    };
    let robot = [
        "<robot name='all' xmlns:drake='http://drake.mit.edu'><link name='base'/>".to_owned(),
        link("a") + &link("b") + &link("c") + &link("d"),
        joint("j1", ["base", "a"], "<origin quat_xyzw='0 0 0 1'/>"),
        joint("j2", ["a", "b"], ""),
        joint("j3", ["b", "c"], "<mimic joint='j2' multiplier='2' offset='1'/>"),
        joint("j4", ["base", "d"], ""),
        "<coupling name='k'><predecessor link='a'/><successor link='d'/><ratio value='2'/></coupling>
         <loop name='l' type='revolute'><predecessor link='a'><origin/></predecessor><successor link='d' xyz='0 0 0'/>
           <axis xyz='0 0 1'/><parent_axis xyz='0 0 1'/><child_axis xyz='0 0 1'/></loop>
         <constraint name='n' type='spherical'><parent link='a'/><child link='d'/><parent_origin xyz='0 0 0'/>
           <child_origin xyz='0 0 0'/></constraint>
         <loop name='m' type='fixed'><predecessor link='a' rpy='0 0 0'/><successor link='d'/></loop>
         <loop_joint name='o' type='fixed'><link1 link='a'/><link2 link='d'/></loop_joint>
         <drake:ball_constraint><drake:ball_constraint_body_A name='a'/><drake:ball_constraint_body_B name='d'/>
           <drake:ball_constraint_p_AP value='0 0 0'/><drake:ball_constraint_p_BQ value='0 0 0'/></drake:ball_constraint>
         <transmission name='t'><type>transmission_interface/SimpleTransmission</type><joint name='j1'/>
           <actuator name='m'><mechanicalReduction>2</mechanicalReduction></actuator></transmission>
         <transmission name='u' type='pr2_mechanism_model/SimpleTransmission'><actuator name='n'/><joint name='j2'/>
           </transmission>
         <ros2_control name='r'><transmission name='v'><plugin>transmission_interface/SimpleTransmission</plugin>
           <joint name='j4'><mechanical_reduction>2</mechanical_reduction></joint></transmission></ros2_control>
         <transmission name='w'><type>transmission_interface/DifferentialTransmission</type>
           <actuator name='x'><role>actuator1</role><drake:rotor_inertia value='0.1'/><drake:gear_ratio value='9'/></actuator>
           <actuator name='y' role='actuator2'/><joint name='j1'><role>joint1</role></joint><joint name='j4' role='joint2'/>
           </transmission>
         <gazebo><joint name='q' type='revolute'><parent>a</parent><child>d</child><pose>0 0 0 0 0 0</pose>
           <axis><xyz>0 0 1</xyz></axis></joint></gazebo>
         </robot>"
            .to_owned(),
    ];
    vec![("robot.urdf", robot.concat())]
}

pub(super) fn sdf() -> Vec<File> {
    let include = "<model name='tool'><link name='tip'/></model>";
    let robot = "<sdf version='1.11'><world name='w'><gravity>0 0 -9.81</gravity><physics/>
        <model name='floor'><static>true</static><link name='slab'/></model>
        <model name='all' placement_frame='foot' canonical_link='a'><static>false</static><pose degrees='true'
          rotation_format='euler_rpy'>0 0 0 0 0 10</pose><plugin name='p' filename='q'><gain>3</gain></plugin><plugin name='r'/>
        <frame name='foot' attached_to='a'><pose relative_to='a'/></frame>
        <link name='a'><gravity>true</gravity><inertial auto='false'><pose/><mass>1</mass><inertia><ixx>1</ixx>
          <ixy>0</ixy><ixz>0</ixz><iyy>1</iyy><iyz>0</iyz><izz>1</izz></inertia></inertial></link>
        <link name='b'/><link name='c'/><link name='d'/><link name='e'/>
        <joint name='j' type='universal'><parent>world</parent><child>a</child>
          <axis><xyz expressed_in='__model__'>0 0 1</xyz><dynamics><damping>0.1</damping><friction>0.1</friction>
          <spring_stiffness>1</spring_stiffness><spring_reference>0</spring_reference></dynamics>
          <limit><lower>-1</lower><upper>1</upper><velocity>2</velocity></limit></axis>
          <axis2><xyz>0 1 0</xyz></axis2></joint>
        <joint name='k' type='revolute'><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint>
        <joint name='l' type='revolute'><parent>a</parent><child>c</child><axis><xyz>0 0 1</xyz></axis></joint>
        <joint name='g' type='gearbox'><parent>b</parent><child>c</child><gearbox_ratio>3</gearbox_ratio>
          <gearbox_reference_body>a</gearbox_reference_body><axis><xyz>0 0 1</xyz></axis>
          <axis2><xyz>0 0 1</xyz></axis2></joint>
        <joint name='s' type='screw'><parent>a</parent><child>d</child>
          <rotor_inertia>0</rotor_inertia><gear_ratio>1</gear_ratio>
          <screw_thread_pitch>0.01</screw_thread_pitch><axis><xyz>0 0 1</xyz></axis></joint>
        <joint name='r' type='screw'><parent>a</parent><child>e</child><thread_pitch>-100</thread_pitch><axis>
          <xyz>0 0 1</xyz><mimic joint='k' axis='axis' multiplier='1' offset='0'><multiplier>2</multiplier><offset>0</offset>
          <reference>0</reference></mimic></axis></joint>
        <include merge='false'><uri>included.sdf</uri><name>tool</name><pose/><placement_frame>tip</placement_frame>
          <static>false</static></include>
        <joint name='t' type='fixed'><parent>a</parent><child>tool::tip</child></joint>
        </model></world></sdf>";
    let old =
        "<sdf version='1.5'><model name='old'><link name='a'/><joint name='j' type='revolute'>
        <parent>world</parent><child>a</child><pose frame='a'/><axis><xyz>0 0 1</xyz>
        <use_parent_model_frame>true</use_parent_model_frame></axis></joint></model></sdf>";
    vec![
        ("robot.sdf", robot.to_owned()),
        ("old.sdf", old.to_owned()),
        (
            "older.sdf",
            old.replace("<sdf", "<gazebo").replace("/sdf", "/gazebo"),
        ),
        (
            "included.sdf",
            format!("<sdf version='1.11'>{include}</sdf>"),
        ),
    ]
}
